#include "server/worker/workshop.h"

#include <spdlog/spdlog.h>

#include "renderer/base/parallel.h"

namespace translucube::server {

int Workshop::cores() const { return thread_count(threads); }

void tidy(Workshop& workshop, const std::string& job_id) {
  const std::optional<Job> job = workshop.store.find(job_id);
  if (job && job->state != api::JobState::canceled && job->state != api::JobState::failed) return;
  try {
    workshop.artifacts.remove_all(job_id);
  } catch (const FileError& error) {
    spdlog::warn("render {}: {}", job_id, error.what());  // the next start tries again
  }
}

}  // namespace translucube::server
