#pragma once

#include <stop_token>
#include <thread>

#include "server/store/job_store.h"

namespace translucube::server {

/// Stands by while a task is worked on: renews its lease, and stops the work when the lease is lost
/// (canceled, removed, given to another worker).
class TaskWatch {
 public:
  TaskWatch(JobStore& store, const Task& task, std::stop_source work);

 private:
  std::jthread thread_;
};

}  // namespace translucube::server
