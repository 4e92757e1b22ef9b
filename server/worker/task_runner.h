#pragma once

#include <limits>
#include <stop_token>
#include <string>

#include "server/worker/hand.h"
#include "server/worker/trace.h"

namespace translucube::server {

/// Works on claimed tasks, one at a time: leads them through trace() and accept(), and whatever
/// fails back to the store.
class TaskRunner {
 public:
  explicit TaskRunner(Workshop& workshop) : workshop_(workshop) {}

  /// Traces the task's pass, merges it, and ends the job or plans its next pass. Whatever fails
  /// ends in the store: as a failed job, or as a task to try again, without end where the world is
  /// at fault. `work` stops the tracing; the
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
  void settle(const Task& task);
  void refuse(const Task& task, const api::RenderRequest& request, const SceneError& error);
  void fail(const Task& task, const api::Problem& problem);
  static constexpr int any_number = std::numeric_limits<int>::max();
  bool wait(const Task& task, const Setback& setback, int most = any_number);

  Workshop& workshop_;
  Hand hand_;
};

}  // namespace translucube::server
