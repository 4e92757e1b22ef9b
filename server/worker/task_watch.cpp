#include "server/worker/task_watch.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace translucube::server {
namespace {

// Early, so that the store knows of a task that it takes its time.
constexpr std::chrono::milliseconds first_renewal(500);

void watch(std::stop_token ended, JobStore& store, const Task& task, std::stop_source work) {
  const std::chrono::milliseconds renewal(std::max<std::int64_t>(store.lease_ms() / 3, 1));
  auto next = std::min(renewal, first_renewal);
  std::mutex mutex;
  std::condition_variable_any condition;
  std::unique_lock lock(mutex);
  while (true) {
    condition.wait_for(lock, ended, std::exchange(next, renewal), [] { return false; });
    if (ended.stop_requested()) return;
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

}  // namespace

TaskWatch::TaskWatch(JobStore& store, const Task& task, std::stop_source work)
    : thread_([&store, task, work](std::stop_token ended) { watch(ended, store, task, work); }) {}

}  // namespace translucube::server
