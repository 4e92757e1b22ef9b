#include "server/worker/workshop.h"

#include <spdlog/spdlog.h>

#include "renderer/base/parallel.h"

namespace translucube::server {

int Workshop::cores() const { return thread_count(threads); }

void tidy(Workshop& workshop, const std::string& job_id) {
  try {
    const std::optional<Job> job = workshop.store.find(job_id);
    if (!job || api::is_end(job->state)) workshop.artifacts.remove_all(job_id);
  } catch (const std::exception& error) {                 // StoreError, FileError
    spdlog::warn("render {}: {}", job_id, error.what());  // the next start tries again
  }
}

}  // namespace translucube::server
