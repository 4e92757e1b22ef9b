#include "api/render_status.h"

#include "api/status_json.h"

namespace translucube::api {
namespace {

using nlohmann::json;

json status_object(const RenderStatus& status) {
  const std::string self = "/v1/renders/" + status.id;
  return {
      {"id", status.id},
      {"state", name(status.state)},
      {"created_at", status.created_at},
      {"started_at", value_or_null(status.started_at)},
      {"finished_at", value_or_null(status.finished_at)},
      {"progress", progress_object(status.progress)},
      {"request", parsed(status.request, "the request of a render")},
      {"material", parsed(status.material, "the material report of a render")},
      {"stats", parsed_or_null(status.stats, "the stats of a render")},
      {"error", parsed_or_null(status.error, "the error of a render")},
      {"cached", status.cached},
      {"links",
       {{"self", self},
        {"image", self + "/image"},
        {"events", self + "/events"},
        {"cancel", self + "/cancel"}}},
  };
}

}  // namespace

std::string to_json(const RenderStatus& status) { return status_object(status).dump(); }

std::string render_list_json(const std::vector<RenderStatus>& renders,
                             const std::optional<std::string>& next_cursor) {
  json list = json::array();
  for (const RenderStatus& status : renders) list.push_back(status_object(status));
  return json{{"renders", std::move(list)}, {"next_cursor", value_or_null(next_cursor)}}.dump();
}

std::string stats_json(const RenderStats& stats) {
  return json{{"samples", stats.samples},
              {"seconds", finite_or_null(stats.seconds)},
              {"cpu_seconds", finite_or_null(stats.cpu_seconds)},
              {"threads", stats.threads},
              {"relative_error", finite_or_null(stats.relative_error)},
              {"transport", stats.transport},
              {"traced_images", stats.traced_images},
              {"nan_samples", stats.nan_samples},
              {"truncated_energy", finite_or_null(stats.truncated_energy)}}
      .dump();
}

}  // namespace translucube::api
