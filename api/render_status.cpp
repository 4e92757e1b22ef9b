#include "api/render_status.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace translucube::api {
namespace {

using nlohmann::json;

json finite_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

template <typename T>
json value_or_null(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

json parsed(const std::string& text, const char* what) {
  json value = json::parse(text, nullptr, false);
  if (value.is_discarded()) throw std::invalid_argument(std::string("not JSON: ") + what);
  return value;
}

json parsed_or_null(const std::optional<std::string>& text, const char* what) {
  return text ? parsed(*text, what) : json(nullptr);
}

json status_object(const RenderStatus& status) {
  const std::string self = "/v1/renders/" + status.id;
  const Progress& progress = status.progress;
  return {
      {"id", status.id},
      {"state", name(status.state)},
      {"created_at", status.created_at},
      {"started_at", value_or_null(status.started_at)},
      {"finished_at", value_or_null(status.finished_at)},
      {"progress",
       {{"samples", progress.samples},
        {"total_samples", value_or_null(progress.total_samples)},
        // Zero is what a Progress holds before it was ever computed; no estimate is ever exactly 0
        // but that of a picture without noise, which has passes.
        {"relative_error", progress.passes == 0 && progress.relative_error == 0
                               ? json(nullptr)
                               : finite_or_null(progress.relative_error)},
        {"seconds", finite_or_null(progress.seconds)},
        {"eta_seconds",
         progress.eta_seconds ? finite_or_null(*progress.eta_seconds) : json(nullptr)}}},
      {"request", parsed(status.request, "the request of a render")},
      {"material", parsed(status.material, "the material report of a render")},
      {"stats", parsed_or_null(status.stats, "the stats of a render")},
      {"error", parsed_or_null(status.error, "the error of a render")},
      {"links", {{"self", self}, {"image", self + "/image"}, {"cancel", self + "/cancel"}}},
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
