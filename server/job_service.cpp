#include "server/job_service.h"

#include <spdlog/spdlog.h>

#include "api/parse.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;

// Probes may come often; each writes to the disk.
constexpr std::chrono::seconds probe_interval(1);
constexpr std::string_view cursor_prefix = "before-";

Problem no_such_render() { return {ProblemCode::not_found, "There is no render of this id.", {}}; }

/// Runs `work`; what the disk refuses becomes a problem that tells a client no inner detail.
template <typename T, typename Work>
T guarded(Work&& work) {
  try {
    return work();
  } catch (const StoreError& error) {
    spdlog::error("{}", error.what());
  } catch (const FileError& error) {
    spdlog::error("{}", error.what());
  }
  return Problem{
      ProblemCode::storage_failure, "The disk of the service is full or cannot be used.", {}};
}

api::RenderStatus status_of(const Job& job) {
  api::RenderStatus status;
  status.id = job.id;
  status.state = job.state;
  status.created_at = rfc3339(job.created_ms);
  if (job.started_ms) status.started_at = rfc3339(*job.started_ms);
  if (job.finished_ms) status.finished_at = rfc3339(*job.finished_ms);
  status.progress = job.progress;
  status.request = job.request;
  status.material = job.material;
  status.stats = job.stats;
  status.error = job.error;
  return status;
}

}  // namespace

JobService::JobService(const api::Catalog& catalog, const ColorConfig& colors, JobStore& store,
                       ArtifactStore& artifacts, Engine engine)
    : catalog_(catalog),
      colors_(colors),
      store_(store),
      artifacts_(artifacts),
      darkroom_{catalog, colors, artifacts} {
  clean_artifacts();
  workers_ = std::make_unique<WorkerPool>(
      Workshop{catalog, store, artifacts, std::move(engine), catalog.server.threads_per_worker},
      catalog.server.workers, [this] { changed(); });
}

JobService::~JobService() { shut_down(); }

void JobService::changed() {
  {
    const std::lock_guard lock(mutex_);
    ++changes_;
  }
  change_.notify_all();
}

/// Removes what a crash left: files of renders that were removed or ended without an image, and
/// beside an image its checkpoints and what a late double of its last task wrote. Derived pictures
/// go too: the colour config may be another one since they were made.
void JobService::clean_artifacts() {
  for (const std::string& id : artifacts_.ids()) {
    if (!is_id(id)) continue;
    const std::optional<Job> job = store_.find(id);
    if (!job || job->state == api::JobState::canceled || job->state == api::JobState::failed)
      artifacts_.remove_all(id);
    else if (job->image)
      for (const std::string& name : artifacts_.names(id))
        if (name != *job->image) artifacts_.remove(id, name);
  }
}

/// Nobody can ask for these files any more: what cannot be removed now, because a worker is writing
/// there for a moment yet, is removed by that worker or at the next start.
void JobService::discard_files(const std::string& id) {
  try {
    artifacts_.remove_all(id);
  } catch (const FileError& error) {
    spdlog::warn("render {}: {}", id, error.what());
  }
}

std::optional<Problem> JobService::refusal() const {
  const std::lock_guard lock(mutex_);
  if (!stopping_) return std::nullopt;
  return Problem{ProblemCode::overloaded, "The service is shutting down.", {}};
}

Result<Submission> JobService::submit(std::string_view document,
                                      const std::optional<std::string>& idempotency_key) {
  if (const auto problem = refusal()) return *problem;
  auto parsed = api::parse_render_request(document, catalog_);
  if (auto* problem = std::get_if<Problem>(&parsed)) return std::move(*problem);
  const auto& request = std::get<api::RenderRequest>(parsed);

  NewJob job;
  job.request = api::canonical_json(request);
  job.material = api::material_report(request, catalog_);
  job.idempotency_key = idempotency_key;
  if (const auto* target = std::get_if<SampleTarget>(&request.quality))
    job.total_samples = target->samples;
  const std::uint64_t pixels = std::uint64_t(request.width) * std::uint64_t(request.height);
  job.first_pass = plan_pass(0, pixels, job.total_samples).value();

  return guarded<Result<Submission>>([&]() -> Result<Submission> {
    const auto outcome = store_.submit(job);
    if (std::holds_alternative<IdempotencyMismatch>(outcome))
      return Problem{ProblemCode::idempotency_mismatch,
                     "This Idempotency-Key came before, with another request.",
                     {}};
    const auto& submitted = std::get<Submitted>(outcome);
    if (submitted.created) workers_->wake();
    return Submission{status_of(submitted.job), submitted.created};
  });
}

Result<api::RenderStatus> JobService::get(const std::string& id) const {
  return guarded<Result<api::RenderStatus>>([&]() -> Result<api::RenderStatus> {
    const std::optional<Job> job = store_.find(id);
    if (!job) return no_such_render();
    return status_of(*job);
  });
}

Result<RenderPage> JobService::list(const ListQuery& query) const {
  JobFilter filter{query.state, std::nullopt, query.limit + 1};
  if (query.cursor) {
    const std::string_view cursor = *query.cursor;
    if (!cursor.starts_with(cursor_prefix) || !is_id(cursor.substr(cursor_prefix.size())))
      return Problem{ProblemCode::invalid_request,
                     "A query parameter is not valid.",
                     {{"?cursor", "not a cursor that this service gave"}}};
    filter.before_id = cursor.substr(cursor_prefix.size());
  }
  return guarded<Result<RenderPage>>([&]() -> Result<RenderPage> {
    std::vector<Job> jobs = store_.list(filter);
    RenderPage page;
    if (std::ssize(jobs) > query.limit) {
      jobs.resize(static_cast<std::size_t>(query.limit));
      page.next_cursor = std::string(cursor_prefix) + jobs.back().id;
    }
    for (const Job& job : jobs) page.renders.push_back(status_of(job));
    return page;
  });
}

Result<api::RenderStatus> JobService::cancel(const std::string& id) {
  return guarded<Result<api::RenderStatus>>([&]() -> Result<api::RenderStatus> {
    const std::optional<Job> job = store_.cancel(id);
    if (!job) return no_such_render();
    if (job->state == api::JobState::canceled) {
      workers_->stop_job(id);
      discard_files(id);
      changed();
    }
    return status_of(*job);
  });
}

std::optional<Problem> JobService::remove(const std::string& id) {
  const auto result = guarded<Result<bool>>([&]() -> Result<bool> { return store_.remove(id); });
  if (const auto* problem = std::get_if<Problem>(&result)) return *problem;
  if (!std::get<bool>(result)) return no_such_render();
  workers_->stop_job(id);
  discard_files(id);
  changed();
  return std::nullopt;
}

Result<api::RenderStatus> JobService::wait(const std::string& id, std::chrono::milliseconds time) {
  const auto deadline = std::chrono::steady_clock::now() + time;
  while (true) {
    std::uint64_t seen = 0;
    {
      const std::lock_guard lock(mutex_);
      seen = changes_;
    }
    Result<api::RenderStatus> result = get(id);
    const auto* status = std::get_if<api::RenderStatus>(&result);
    if (!status || api::is_end(status->state)) return result;
    std::unique_lock lock(mutex_);
    if (!change_.wait_until(lock, deadline, [&] { return changes_ != seen || stopping_; }) ||
        stopping_)
      return result;
  }
}

Result<ImageFile> JobService::image(const std::string& id, const ImageQuery& query) {
  return guarded<Result<ImageFile>>([&]() -> Result<ImageFile> {
    const std::optional<Job> job = store_.find(id);
    if (!job) return no_such_render();
    switch (job->state) {
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
    auto made = image_artifact(darkroom_, *job, query);
    if (auto* problem = std::get_if<Problem>(&made)) {
      // Removed while it was read: then that is the answer.
      if (problem->code == ProblemCode::internal && !store_.find(id)) return no_such_render();
    }
    return made;
  });
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

void JobService::shut_down() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  change_.notify_all();
  workers_->stop();
}

}  // namespace translucube::server
