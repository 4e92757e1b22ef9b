#pragma once

// The room of what works on tasks: they are claimed (WorkerPool), led from one stage to the next
// (TaskRunner), traced (trace.h, which may run on any machine) and merged (accept.h, which tells
// the store what follows). Nothing here knows of clients or of the forms of pictures that they see.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/worker/task_runner.h"

namespace translucube::server {

/// A bounded pool of threads that claim tasks and work on them. Tasks of different renders run at
/// the same time; those of one render follow each other, since each plans the next. Of several
/// workers the first takes no batch work, so that whoever waits for a picture is never behind more
/// than other such pictures; the others take three interactive tasks for one of a batch while both
/// kinds wait. They yield the processor to the threads that answer.
class WorkerPool {
 public:
  /// `on_change` is called by the workers whenever a job in the store has changed; `intake` says
  /// which tasks may be begun beside so many others at work.
  WorkerPool(Workshop workshop, int workers, std::function<void()> on_change,
             std::function<Intake(int others)> intake);
  ~WorkerPool();  ///< stops

  void wake();                           ///< there may be a task
  void stop_job(const std::string& id);  ///< stops the pass that is traced for it, if one is
  /// Starts no pass; those under way may take `time` to end.
  void drain(std::chrono::milliseconds time);
  void stop();  ///< stops all passes, gives their tasks back, waits for the threads

 private:
  void work(int worker, std::stop_token stop);
  std::optional<Task> claim(int worker, const std::string& in_hand);
  void run(TaskRunner& runner, const Task& task, std::stop_token stop);

  Workshop workshop_;
  std::function<void()> on_change_;
  std::function<Intake(int others)> intake_;
  std::mutex mutex_;
  std::condition_variable_any awake_, idle_;
  std::uint64_t wakes_ = 0;
  bool draining_ = false;
  int busy_ = 0;  ///< workers that claim or work
  std::atomic<unsigned> turns_ = 0;
  int workers_;
  std::multimap<std::string, std::stop_source> running_;  ///< by job
  std::vector<std::jthread> threads_;
};

}  // namespace translucube::server
