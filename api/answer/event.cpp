#include "api/answer/event.h"

#include "api/answer/status_json.h"

namespace translucube::api {

using nlohmann::json;

std::string progress_event(const Progress& progress) { return progress_object(progress).dump(); }

std::string state_event(JobState state, const Progress& progress,
                        const std::optional<std::string>& error) {
  return json{{"state", name(state)},
              {"progress", progress_object(progress)},
              {"error", parsed_or_null(error, "the error of a render")}}
      .dump();
}

std::string sweep_event(JobState state, const StateCounts& counts) {
  return json{{"state", name(state)}, {"counts", counts_object(counts)}}.dump();
}

std::string points_event(const std::vector<std::uint32_t>& points, JobState state,
                         const StateCounts& counts) {
  return json{{"points", points}, {"state", name(state)}, {"counts", counts_object(counts)}}.dump();
}

}  // namespace translucube::api
