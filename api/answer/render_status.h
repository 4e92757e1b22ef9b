#pragma once

// The room of answers: what the service and the command line say, as JSON. The values are the
// caller's; nothing is looked up here. This header: what is said of a render.

#include <optional>
#include <string>
#include <vector>

#include "api/base/job_state.h"
#include "api/base/problem.h"
#include "renderer/render.h"

namespace translucube::api {

/// Times are RFC 3339 in UTC ("2026-01-31T12:00:00.000Z"). The fields that hold JSON text are what
/// the functions named beside them gave, as a store keeps them.
struct RenderStatus {
  std::string id;
  JobState state = JobState::queued;
  std::string created_at;
  std::optional<std::string> started_at, finished_at;
  Progress progress;                 ///< `passes` is not told
  std::string request;               ///< JSON text of canonical_json
  std::string material;              ///< JSON text of material_report
  std::optional<std::string> stats;  ///< JSON text of stats_json
  std::optional<std::string> error;  ///< JSON text of to_json(Problem)
  bool cached = false;               ///< the same picture was there: nothing was traced for it
};

/// The answer to GET /v1/renders/{id}; links are built from the id. Throws std::invalid_argument if
/// one of the JSON texts is none (a corrupt store).
std::string to_json(const RenderStatus& status);

/// The answer to GET /v1/renders: {"renders": [...], "next_cursor": "..." or null}. Without those
/// whose JSON texts are none.
std::string render_list_json(const std::vector<RenderStatus>& renders,
                             const std::optional<std::string>& next_cursor);

/// What --stats writes and an answer's `stats` holds; NaN and infinities are null.
std::string stats_json(const RenderStats& stats);

}  // namespace translucube::api
