#include "server/worker/worker_pool.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>

namespace translucube::server {

// Leases run out and delayed tasks fall due without anyone saying so.
constexpr std::chrono::milliseconds poll_interval(500);
constexpr unsigned interactive_share = 3;  ///< interactive tasks for one of a batch
constexpr int nicer_than_others = 10;

WorkerPool::WorkerPool(Workshop workshop, int workers, std::function<void()> on_change,
                       std::function<Intake(int others)> intake)
    : workshop_(std::move(workshop)),
      on_change_(std::move(on_change)),
      intake_(std::move(intake)),
      workers_(workers) {
  for (int i = 0; i < workers; ++i)
    threads_.emplace_back([this, i](std::stop_token stop) { work(i, stop); });
}

WorkerPool::~WorkerPool() { stop(); }

void WorkerPool::stop() {
  for (std::jthread& thread : threads_) thread.request_stop();
  threads_.clear();  // joins
}

void WorkerPool::drain(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  draining_ = true;
  idle_.wait_for(lock, time, [this] { return busy_ == 0; });
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

std::optional<Task> WorkerPool::claim(int worker, const std::string& in_hand) {
  JobStore& store = workshop_.store;
  const Intake intake = intake_([&] {
    const std::lock_guard lock(mutex_);
    return static_cast<int>(running_.size());
  }());
  if (workers_ > 1 && worker == 0) return store.claim(Priority::interactive, in_hand, intake);
  const bool batch_first = turns_++ % (interactive_share + 1) == interactive_share;
  const Priority first = batch_first ? Priority::batch : Priority::interactive;
  const Priority second = batch_first ? Priority::interactive : Priority::batch;
  auto task = store.claim(first, in_hand, intake);
  return task ? task : store.claim(second, in_hand, intake);
}

void WorkerPool::work(int worker, std::stop_token stop) {
  // Per thread on Linux, and inherited by those that the renderer starts. Without the right to it
  // the work goes on.
  const auto self = static_cast<id_t>(::gettid());
  ::setpriority(PRIO_PROCESS, self, ::getpriority(PRIO_PROCESS, self) + nicer_than_others);
  TaskRunner runner(workshop_);
  while (!stop.stop_requested()) {
    std::uint64_t seen = 0;
    {
      const std::lock_guard lock(mutex_);
      if (draining_) break;
      seen = wakes_;
      ++busy_;
    }
    std::optional<Task> task;
    try {
      task = claim(worker, runner.job_in_hand());
      if (task)
        run(runner, *task, stop);
      else
        runner.put_down();
    } catch (const std::exception& error) {  // StoreError, or no memory
      spdlog::error("a worker has no task: {}", error.what());
      task.reset();
    }
    std::unique_lock lock(mutex_);
    if (--busy_ == 0) idle_.notify_all();
    if (task) continue;
    awake_.wait_for(lock, stop, poll_interval, [&] { return wakes_ != seen; });
  }
  runner.put_down();
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
