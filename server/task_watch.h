#pragma once

#include <atomic>
#include <chrono>
#include <stop_token>
#include <thread>

#include "server/job_store.h"

namespace translucube::server {

/// Stands by while a task is worked on: renews its lease, and stops the work when the lease is lost
/// (canceled, removed, given to another worker) or when the deadline has come.
class TaskWatch {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  static constexpr TimePoint no_deadline = TimePoint::max();
  TaskWatch(JobStore& store, const Task& task, std::stop_source work, TimePoint deadline);

  bool out_of_time() const { return out_of_time_; }

 private:
  void watch(std::stop_token ended, JobStore& store, const Task& task, std::stop_source work,
             TimePoint deadline);

  std::atomic<bool> out_of_time_ = false;
  std::jthread thread_;  // last: it ends before the members that it uses
};

}  // namespace translucube::server
