#pragma once

// What the service says about a sweep.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/base/job_state.h"
#include "api/request/sweep.h"

namespace translucube::api {

/// One traced image of the sweep.
struct SweepImageStatus {
  std::vector<std::uint32_t> points;  ///< that are developed from it
  JobState state = JobState::queued;
  std::optional<std::string> stats;  ///< JSON text of stats_json
  std::optional<std::string> error;  ///< JSON text of to_json(Problem)
  bool cached = false;               ///< its pictures were there: nothing was traced
};

/// Times are RFC 3339 in UTC.
struct SweepStatus {
  std::string id;
  JobState state = JobState::queued;
  std::string created_at;
  std::optional<std::string> started_at, finished_at;
  Sweep sweep;
  std::vector<SweepImageStatus> images;
};

/// The answer to GET /v1/sweeps/{id}:
///   points, traced_images   how many there are
///   counts                  points in each state
///   stats                   sums over the images that are finished: traced_images, cached_images,
///                           seconds, cpu_seconds, nan_samples
///   results                 for each point: point (its number), absorption, roughness, scattering,
///                           absorber (its label), seed, state, samples, relative_error (of the
///                           least absorbing point of its traced image), error, image (a link where
///                           it has succeeded)
///   request, links, id, state, created_at, started_at, finished_at
/// Throws std::invalid_argument where a JSON text is none.
std::string to_json(const SweepStatus& status);

/// A sweep without its results, for a list.
struct SweepSummary {
  std::string id;
  JobState state = JobState::queued;
  std::string created_at;
  std::optional<std::string> started_at, finished_at;
  std::uint32_t points = 0, traced_images = 0;
};
/// The answer to GET /v1/sweeps: {"sweeps": [...], "next_cursor": "..." or null}.
std::string sweep_list_json(const std::vector<SweepSummary>& sweeps,
                            const std::optional<std::string>& next_cursor);

/// "red-glass", or "absorber 2" for the second one of the sweep if it is not a named one.
std::string absorber_label(const Sweep& sweep, std::size_t absorber);

}  // namespace translucube::api
