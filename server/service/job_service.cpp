// The life of the service itself: its start, its end, and whether it is ready.

#include "server/service/job_service.h"

#include <spdlog/spdlog.h>

namespace translucube::server {

JobService::JobService(const api::Catalog& catalog, const ServerConfig& config,
                       const ColorConfig& colors, JobStore& store, ArtifactStore& artifacts,
                       Metrics& metrics, Engine engine)
    : catalog_(catalog),
      config_(config),
      store_(store),
      metrics_(metrics),
      janitor_(store, artifacts),
      probe_(store, artifacts),
      live_films_([this] { changes_.tell(); }),
      explorables_(config.explorable_memory_bytes),
      darkroom_{catalog, colors, store, artifacts, metrics, explorables_} {
  janitor_.clean_up();
  workers_ = std::make_unique<WorkerPool>(
      Workshop{catalog, store, artifacts, metrics, live_films_, explorables_, std::move(engine),
               config.threads_per_worker},
      config.workers, [this] {
        if (janitor_.keep_within(config_.artifact_bytes)) pictures_.forget();
        changes_.tell();
      });
}

JobService::~JobService() { shut_down(); }

std::optional<api::Problem> JobService::refusal() const {
  if (!changes_.ended()) return std::nullopt;
  return api::Problem{api::ProblemCode::overloaded, "The service is shutting down.", {}};
}

std::optional<std::string> JobService::unready_reason() {
  if (const auto problem = refusal()) return problem->detail;
  return probe_.failure();
}

void JobService::stop_work(const std::string& job_id) {
  workers_->stop_job(job_id);
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
}

}  // namespace translucube::server
