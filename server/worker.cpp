#include "server/worker.h"

#include <spdlog/spdlog.h>

#include <chrono>

namespace translucube::server {

// Leases run out and delayed tasks fall due without anyone saying so.
constexpr std::chrono::milliseconds poll_interval(500);

WorkerPool::WorkerPool(Workshop workshop, int workers, std::function<void()> on_change)
    : workshop_(std::move(workshop)), on_change_(std::move(on_change)) {
  for (int i = 0; i < workers; ++i)
    threads_.emplace_back([this](std::stop_token stop) { work(stop); });
}

WorkerPool::~WorkerPool() { stop(); }

void WorkerPool::stop() {
  for (std::jthread& thread : threads_) thread.request_stop();
  threads_.clear();  // joins
}

void WorkerPool::wake() {
  {
    const std::lock_guard lock(mutex_);
    ++wakes_;
  }
  awake_.notify_all();
}

void WorkerPool::stop_job(const std::string& id) {
  const std::lock_guard lock(mutex_);
  for (auto [at, end] = running_.equal_range(id); at != end; ++at) at->second.request_stop();
}

void WorkerPool::work(std::stop_token stop) {
  TaskRunner runner(workshop_);
  while (!stop.stop_requested()) {
    std::uint64_t seen = 0;
    {
      const std::lock_guard lock(mutex_);
      seen = wakes_;
    }
    std::optional<Task> task;
    try {
      task = workshop_.store.claim(runner.job_in_hand());
    } catch (const StoreError& error) {
      spdlog::error("no task claimed: {}", error.what());
    }
    if (task) {
      run(runner, *task, stop);
      continue;
    }
    runner.forget();
    std::unique_lock lock(mutex_);
    awake_.wait_for(lock, stop, poll_interval, [&] { return wakes_ != seen; });
  }
}

void WorkerPool::run(TaskRunner& runner, const Task& task, std::stop_token stop) {
  std::stop_source source;
  // Known to stop_job before the runner looks whether the job still wants to be worked on.
  const auto entry = [&] {
    const std::lock_guard lock(mutex_);
    return running_.emplace(task.job_id, source);
  }();
  on_change_();
  {
    const std::stop_callback forward(stop, [&] { source.request_stop(); });
    runner.run(task, source);
  }
  {
    const std::lock_guard lock(mutex_);
    running_.erase(entry);
  }
  on_change_();
}

}  // namespace translucube::server
