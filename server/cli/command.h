#pragma once

// How the command of a verb is refused, interrupted and ended.

#include <atomic>
#include <functional>
#include <stop_token>
#include <string>

#include "api/base/result.h"
#include "renderer/render.h"

namespace translucube::server {

inline constexpr int exit_failure = 1;      ///< the machine's fault
inline constexpr int exit_bad_request = 2;  ///< the caller's

/// Ends the command with a message and an exit status.
struct Refusal {
  int status;
  std::string message;
};
Refusal refusal_of(const api::Problem& problem);

/// The value; throws the Refusal of a problem.
template <typename T>
T accepted(api::Result<T> result) {
  if (!result) throw refusal_of(result.problem());
  return *std::move(result);
}

/// Throws Refusal where a sample is not a number: the picture is not written.
void refuse_nan(const RenderStats& stats);

/// Runs a verb: what it throws becomes a message on standard error and the exit status. `made`, for
/// such a message: what there may be too little memory for, "render".
int ended_command(const char* made, const std::function<int()>& verb);

/// SIGINT or SIGTERM, which ask a verb to stop.
struct Interruption {
  std::stop_token stop;
  const std::atomic<int>& signal;  ///< 0 where there was none
  int exit_status() const { return 128 + signal; }
};
/// Runs a verb as `ended_command` does, but for one that stops as it is asked to.
int interruptible_command(const char* made, const std::function<int(const Interruption&)>& verb);

}  // namespace translucube::server
