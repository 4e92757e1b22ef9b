#pragma once

#include <array>
#include <cstdint>

#include "api/base/job_state.h"

namespace translucube::server {

/// The state of a sweep that has not ended, by the number of its points in each state. It runs from
/// its first point on and ends with its last: well where one of them has succeeded.
api::JobState sweep_state(api::JobState before,
                          const std::array<std::uint64_t, api::all_job_states.size()>& points);

}  // namespace translucube::server
