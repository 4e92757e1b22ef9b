#pragma once

// The room of what works on tasks. trace() makes the film of a pass and may run on any machine;
// accept() merges films in the order of passes and tells the store what follows; TaskRunner leads a
// task through both, and whatever fails back to the store. Nothing here knows of clients or HTTP.

#include <stop_token>
#include <string>

#include "server/worker/hand.h"
#include "server/worker/trace.h"

namespace translucube::server {

/// Works on claimed tasks, one at a time.
class TaskRunner {
 public:
  explicit TaskRunner(Workshop& workshop) : workshop_(workshop) {}

  /// Traces the task's pass, merges it, and ends the job or plans its next pass. Whatever fails
  /// ends in the store: as a failed job, or as a task to try again. `work` stops the tracing; the
  /// task is then given back. Does not throw.
  void run(const Task& task, std::stop_source work);
  /// Frees the memory of the last job. What is not on the disk of it is written first.
  void put_down() { server::put_down(workshop_, hand_); }
  const std::string& job_in_hand() const { return hand_.id; }

 private:
  void run_or_throw(const Task& task, std::stop_source work);
  bool take_in_hand(const Task& task, const Job& job, std::stop_token stop);
  std::variant<TracedPass, OutOfTime, Stopped> trace_or_read(const Task& task,
                                                             std::stop_source work);
  void give_back(const Task& task);
  void fail(const Task& task, const api::Problem& problem);
  void retry_later(const Task& task, const std::string& reason);

  Workshop& workshop_;
  Hand hand_;
};

}  // namespace translucube::server
