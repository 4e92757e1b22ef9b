#include "server/store/sweep_state.h"

namespace translucube::server {

using api::JobState;

JobState sweep_state(JobState before,
                     const std::array<std::uint64_t, api::all_job_states.size()>& points) {
  const auto any = [&](JobState state) { return points[static_cast<std::size_t>(state)] > 0; };
  const bool ended = any(JobState::succeeded) || any(JobState::failed) || any(JobState::canceled);
  if (any(JobState::running) || (any(JobState::queued) && ended)) return JobState::running;
  if (any(JobState::queued)) return before;
  return any(JobState::succeeded) ? JobState::succeeded
         : any(JobState::failed)  ? JobState::failed
                                  : JobState::canceled;
}

}  // namespace translucube::server
