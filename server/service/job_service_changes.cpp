// The life of the service itself: what changes, what is cleaned up, its start and its end.

#include <algorithm>

#include "server/service/job_service_parts.h"
#include "server/store/content.h"

namespace translucube::server {

using api::Problem;
using api::ProblemCode;
using api::Result;

namespace {

// Probes may come often; each writes to the disk.
constexpr std::chrono::seconds probe_interval(1);
constexpr std::string_view cursor_prefix = "before-";

}  // namespace

Result<JobFilter> page_filter(const ListQuery& query) {
  JobFilter filter{query.state, std::nullopt, query.limit + 1};
  if (!query.cursor) return filter;
  const std::string_view cursor = *query.cursor;
  if (!cursor.starts_with(cursor_prefix) || !is_id(cursor.substr(cursor_prefix.size())))
    return Problem{ProblemCode::invalid_request,
                   "A query parameter is not valid.",
                   {{"?cursor", "not a cursor that this service gave"}}};
  filter.before_id = cursor.substr(cursor_prefix.size());
  return filter;
}

std::optional<Problem> no_picture(api::JobState state) {
  switch (state) {
    case api::JobState::queued:
    case api::JobState::running:
      return Problem{ProblemCode::not_ready, "The render is not finished yet.", {}};
    case api::JobState::failed:
      return Problem{ProblemCode::conflict, "The render failed: it has no image.", {}};
    case api::JobState::canceled:
      return Problem{ProblemCode::conflict, "The render was canceled: it has no image.", {}};
    case api::JobState::succeeded:
      break;
  }
  return std::nullopt;
}

JobService::JobService(const api::Catalog& catalog, const ServerConfig& config,
                       const ColorConfig& colors, JobStore& store, ArtifactStore& artifacts,
                       Metrics& metrics, Engine engine)
    : catalog_(catalog),
      config_(config),
      colors_(colors),
      store_(store),
      artifacts_(artifacts),
      metrics_(metrics),
      live_films_([this] { changed(); }),
      explorables_(config.explorable_memory_bytes),
      darkroom_{catalog, colors, store, artifacts, metrics, explorables_} {
  clean_artifacts();
  workers_ = std::make_unique<WorkerPool>(
      Workshop{catalog, store, artifacts, metrics, live_films_, explorables_, std::move(engine),
               config.threads_per_worker},
      config.workers, [this] {
        keep_within_quota();
        changed();
      });
}

JobService::~JobService() { shut_down(); }

void JobService::changed() {
  {
    const std::lock_guard lock(mutex_);
    ++changes_;
  }
  change_.notify_all();
}

void JobService::watch(std::chrono::milliseconds time, const std::function<bool()>& look) {
  const auto deadline = std::chrono::steady_clock::now() + time;
  while (true) {
    std::uint64_t seen = 0;
    {
      const std::lock_guard lock(mutex_);
      seen = changes_;
    }
    if (look()) return;
    std::unique_lock lock(mutex_);
    if (!change_.wait_until(lock, deadline, [&] { return changes_ != seen || stopping_; }) ||
        stopping_)
      return;
  }
}

Result<JobService::Events> JobService::events_of_render(const std::string& id,
                                                        std::uint64_t after) const {
  return guarded([&]() -> Result<Events> {
    // The state first: events that come after it are told next time.
    const std::optional<Job> job = store_.find(id);
    if (!job || job->sweep_image)
      return Problem{ProblemCode::not_found, "There is no render of this id.", {}};
    return Events{store_.events_after(id, after), api::is_end(job->state)};
  });
}

Result<JobService::Events> JobService::events_of_sweep(const std::string& id,
                                                       std::uint64_t after) const {
  return guarded([&]() -> Result<Events> {
    const std::optional<StoredSweep> sweep = store_.find_sweep(id);
    if (!sweep) return Problem{ProblemCode::not_found, "There is no sweep of this id.", {}};
    return Events{store_.events_after(id, after), api::is_end(sweep->state)};
  });
}

/// Removes what a crash left: films of jobs that have ended, pictures that no result names. Derived
/// pictures go too: the colour config may be another one since they were made.
void JobService::clean_artifacts() {
  for (const std::string& folder : artifacts_.ids()) {
    if (!is_id(folder) && !is_content_key(folder)) continue;
    const std::optional<StoredResult> result = store_.find_result(folder);
    const std::optional<Job> job = is_id(folder) ? store_.find(folder) : std::nullopt;
    const bool open = job && !api::is_end(job->state);
    if (!result && !open) {
      artifacts_.remove_all(folder);
      continue;
    }
    if (!result) continue;
    for (const std::string& name : artifacts_.names(folder))
      if (name != result->image && name != explorable_name(result->image))
        artifacts_.remove(folder, name);
    store_.resize_result(folder, artifacts_.bytes(folder));
  }
}

/// Removes results that were not asked for longest, until what is left is nine tenths of the quota:
/// first what is derived, then the pictures. The same request makes them again.
void JobService::keep_within_quota() {
  const std::uint64_t quota = config_.artifact_bytes;
  const std::unique_lock lock(quota_mutex_, std::try_to_lock);
  if (!lock) return;
  try {
    std::uint64_t bytes = store_.result_bytes();
    if (bytes <= quota) return;
    const std::uint64_t goal = quota - quota / 10;
    const auto oldest = store_.least_recently_used(bytes - goal);
    for (const StoredResult& result : oldest) {
      if (bytes <= goal) return;
      for (const std::string& name : artifacts_.names(result.content))
        if (name != result.image && name != explorable_name(result.image))
          artifacts_.remove(result.content, name);
      const std::uint64_t left = artifacts_.bytes(result.content);
      store_.resize_result(result.content, left);
      bytes -= std::min(bytes, result.bytes - std::min(result.bytes, left));
    }
    for (const StoredResult& result : store_.least_recently_used(bytes > goal ? bytes - goal : 0)) {
      if (!store_.remove_result(result)) continue;
      spdlog::info("result {} removed to make room", result.content);
      discard_result(result);
    }
  } catch (const std::runtime_error& error) {
    spdlog::error("no room made: {}", error.what());
  }
}

/// Nobody can ask for these files any more: what cannot be removed now, because a worker is writing
/// there for a moment yet, is removed by that worker or at the next start.
void JobService::discard_files(const std::string& folder) {
  try {
    artifacts_.remove_all(folder);
  } catch (const FileError& error) {
    spdlog::warn("{}: {}", folder, error.what());
  }
}

void JobService::discard_result(const StoredResult& result) {
  pictures_.forget();
  try {
    remove_files(artifacts_, result);
  } catch (const FileError& error) {
    spdlog::warn("result {}: {}", result.content, error.what());
  }
}

std::optional<Problem> JobService::refusal() const {
  const std::lock_guard lock(mutex_);
  if (!stopping_) return std::nullopt;
  return Problem{ProblemCode::overloaded, "The service is shutting down.", {}};
}

bool JobService::stopping() const {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

std::optional<std::string> JobService::unready_reason() {
  if (const auto problem = refusal()) return problem->detail;
  const std::lock_guard lock(probe_mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (now - probed_at_ < probe_interval && probed_at_.time_since_epoch().count() != 0)
    return probe_failure_;
  probed_at_ = now;
  probe_failure_.reset();
  try {
    store_.check_writable();
    artifacts_.check_writable();
  } catch (const std::exception& error) {
    spdlog::error("not ready: {}", error.what());
    probe_failure_ = "The disk of the service is full or cannot be used.";
  }
  return probe_failure_;
}

void JobService::shut_down(std::chrono::milliseconds drain) {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  change_.notify_all();
  workers_->drain(drain);
  workers_->stop();
}

}  // namespace translucube::server
