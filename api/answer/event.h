#pragma once

// What an event stream tells of a render or a sweep.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/base/job_state.h"
#include "renderer/render.h"

namespace translucube::api {

/// {"samples", "total_samples", "relative_error", "seconds", "eta_seconds"}; null where unknown.
std::string progress_event(const Progress& progress);
/// {"state", "progress": as above, "error": a problem or null}
std::string state_event(JobState state, const Progress& progress,
                        const std::optional<std::string>& error);

/// Points of a sweep in each state, by JobState.
using StateCounts = std::array<std::uint64_t, all_job_states.size()>;

/// {"state", "counts": {"queued": 3, ...}}
std::string sweep_event(JobState state, const StateCounts& counts);
/// {"points": [numbers], "state", "counts"}: what became of some points.
std::string points_event(const std::vector<std::uint32_t>& points, JobState state,
                         const StateCounts& counts);

}  // namespace translucube::api
