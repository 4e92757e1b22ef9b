#include "server/store/job_store.h"
#include "server/store/sqlite/sqlite_job_store.h"

namespace translucube::server {

std::unique_ptr<JobStore> open_job_store(const std::string& location, StoreOptions options) {
  return std::make_unique<SqliteJobStore>(location, std::move(options));
}

}  // namespace translucube::server
