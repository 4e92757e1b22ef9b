#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace translucube::api {

/// The life of a render. The last three are ends.
enum class JobState { queued, running, succeeded, failed, canceled };

inline constexpr std::array all_job_states{JobState::queued, JobState::running, JobState::succeeded,
                                           JobState::failed, JobState::canceled};

std::string_view name(JobState state);  ///< "queued", "running", ...
std::optional<JobState> job_state(std::string_view name);

/// The only legal transitions: queued -> running, canceled; running -> succeeded, failed, canceled,
/// and back to queued where its worker died; nothing follows an end, and no state follows itself.
bool may_follow(JobState from, JobState to);

bool is_end(JobState state);

}  // namespace translucube::api
