// The life of the service itself: its start, its end, and whether it is ready.

#include "server/service/job_service.h"

#include <spdlog/spdlog.h>

#include <condition_variable>

#include "api/base/faults.h"
#include "server/base/clock.h"
#include "server/base/memory.h"
#include "server/store/needs.h"

namespace translucube::server {

namespace {

using api::Problem;
using api::ProblemCode;
using std::chrono::seconds;

constexpr seconds between_rounds(1);

/// Code, libraries and answering threads take the rest.
std::uint64_t memory_of_renders(const ServerConfig& config) {
  return config.memory_bytes > 0 ? config.memory_bytes : available_memory() / 4 * 3;
}

}  // namespace

JobService::JobService(const api::Catalog& catalog, const ServerConfig& config,
                       const ColorConfig& colors, JobStore& store, ArtifactStore& artifacts,
                       const DataFolder& folder, Metrics& metrics, Engine engine)
    : catalog_(catalog),
      config_(config),
      store_(store),
      folder_(folder),
      metrics_(metrics),
      janitor_(store, artifacts),
      probe_(store, artifacts, folder, config.artifact_bytes),
      live_films_([this] { changes_.tell(); }),
      explorables_(config.explorable_memory_bytes),
      darkroom_{catalog, colors, store, artifacts, metrics, explorables_},
      pictures_(static_cast<std::size_t>(config.open_pictures), std::chrono::seconds(1)),
      memory_(memory_of_renders(config)) {
  folder_.check();
  janitor_.clean_up();
  workers_ = std::make_unique<WorkerPool>(
      Workshop{catalog, store, artifacts, metrics, live_films_, explorables_, setbacks_, memory_,
               std::move(engine), config.retry_ms, config.threads_per_worker},
      config.workers, [this] { changes_.tell(); }, [this](int others) { return intake(others); });
  house_keeper_ = std::jthread([this](std::stop_token ended) { keep_house(std::move(ended)); });
}

JobService::~JobService() { shut_down(); }

/// What has to be done once in a while, whether there is work or not. On a full disk some of it
/// fails, and what makes room is done all the same.
void JobService::keep_house(std::stop_token ended) {
  const auto attempt = [](const auto& work) {
    try {
      work();
    } catch (const std::exception& error) {  // StoreError, FileError, no memory
      spdlog::error("the house is not kept: {}", error.what());
    }
  };
  std::mutex mutex;
  std::condition_variable_any condition;
  std::unique_lock lock(mutex);
  while (!ended.stop_requested()) {
    attempt([&] {
      room_ = working_room(store_.open_needs().largest);
      if (janitor_.keep_within(config_.artifact_bytes, room_)) pictures_.forget();
      janitor_.give_way(room_);
    });
    attempt([&] { store_.checkpoint(); });
    attempt([&] {
      if (janitor_.forget_old(system_clock_ms() - config_.keep_days * day_ms) == 0) return;
      ended_.forget();
      pictures_.forget();
    });
    condition.wait_for(lock, ended, between_rounds, [] { return false; });
  }
}

/// What is begun must come to its end: each of those at work needs room for it.
Intake JobService::intake(int others) const {
  try {
    folder_.check();
    const auto at_work = static_cast<std::uint64_t>(others) + 1;
    const bool room = darkroom_.artifacts.free_bytes() >= room_ * at_work;
    return room && !janitor_.crowded() ? Intake::all : Intake::begun;
  } catch (const std::exception&) {  // StoreError, FileError
    return Intake::none;             // what is made would be lost
  }
}

std::optional<Problem> JobService::refusal() const {
  if (changes_.ended())
    return Problem{ProblemCode::overloaded, "The service is shutting down.", {}};
  try {
    folder_.check();
  } catch (const StoreError& error) {
    spdlog::error("{}", error.what());
    return Problem{ProblemCode::storage_failure, "The disk of the service cannot be used.", {}};
  }
  return std::nullopt;
}

std::optional<Problem> JobService::no_room(std::uint64_t picture_bytes) {
  auto reason = setbacks_.of_disk();
  if (!reason) reason = probe_.refusal(picture_bytes);
  if (!reason) return std::nullopt;
  return Problem{ProblemCode::storage_failure, *std::move(reason), {}};
}

std::optional<Problem> JobService::too_large(const api::RenderRequest& request, std::uint64_t lanes,
                                             const char* pointer) const {
  const std::uint64_t bytes = memory_of(request, lanes);
  if (bytes <= memory_.bytes()) return std::nullopt;
  api::Faults faults;
  faults.add(pointer, "takes about " + std::to_string(bytes >> 20) + " MiB of memory; there are " +
                          std::to_string(memory_.bytes() >> 20));
  return api::invalid_request(faults);
}

std::optional<std::string> JobService::unready_reason() {
  if (const auto problem = refusal()) return problem->detail;
  if (auto failure = probe_.failure()) return failure;
  return setbacks_.of_service();
}

void JobService::stop_work(const std::string& job_id) {
  workers_->stop_job(job_id);
  setbacks_.clear(job_id);
  janitor_.discard(job_id);
}

void JobService::discard(const std::vector<StoredResult>& unused) {
  pictures_.forget();
  for (const StoredResult& result : unused) janitor_.discard(result);
}

void JobService::shut_down(std::chrono::milliseconds drain) {
  changes_.end();
  try {
    store_.announce_end();
  } catch (const StoreError& error) {
    spdlog::warn("the end is not announced: {}", error.what());
  }
  workers_->drain(drain);
  workers_->stop();
  house_keeper_ = {};
}

}  // namespace translucube::server
