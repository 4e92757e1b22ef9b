#include "server/task_watch.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace translucube::server {

TaskWatch::TaskWatch(JobStore& store, const Task& task, std::stop_source work, TimePoint deadline)
    : thread_([this, &store, task, work, deadline](std::stop_token ended) {
        watch(ended, store, task, work, deadline);
      }) {}

void TaskWatch::watch(std::stop_token ended, JobStore& store, const Task& task,
                      std::stop_source work, TimePoint deadline) {
  using std::chrono::steady_clock;
  const std::chrono::milliseconds renewal(std::max<std::int64_t>(store.lease_ms() / 3, 1));
  TimePoint next_renewal = steady_clock::now() + renewal;

  std::mutex mutex;
  std::condition_variable_any condition;
  std::unique_lock lock(mutex);
  while (true) {
    const TimePoint until = std::min(deadline, next_renewal);
    condition.wait_until(lock, ended, until, [] { return false; });
    if (ended.stop_requested()) return;
    const TimePoint now = steady_clock::now();
    if (now >= deadline) {
      out_of_time_ = true;
      work.request_stop();
      deadline = no_deadline;
    }
    if (now < next_renewal) continue;
    next_renewal = now + renewal;
    try {
      if (!store.renew(task)) {
        work.request_stop();
        return;
      }
    } catch (const StoreError& error) {
      // The work goes on: if the lease runs out meanwhile, its result is refused and made again.
      spdlog::warn("render {}: lease not renewed: {}", task.job_id, error.what());
    }
  }
}

}  // namespace translucube::server
