#include "api/answer/sweep_status.h"

#include "api/answer/status_json.h"

namespace translucube::api {
namespace {

using nlohmann::json;

std::string link(const std::string& id) { return "/v1/sweeps/" + id; }

struct Summary {
  StateCounts counts{};
  int traced = 0, cached = 0;
  double seconds = 0, cpu_seconds = 0;
  std::uint64_t nan_samples = 0;
};

void add_stats(Summary& summary, const json& stats) {
  const auto number = [&](const char* key) {
    const json value = stats.value(key, json());
    return value.is_number() ? value.get<double>() : 0.0;
  };
  summary.seconds += number("seconds");
  summary.cpu_seconds += number("cpu_seconds");
  summary.nan_samples += static_cast<std::uint64_t>(number("nan_samples"));
}

json result_object(const SweepStatus& status, const SweepImageStatus& image, const json& stats,
                   std::uint32_t point) {
  const Sweep& sweep = status.sweep;
  const SweepPlace place = place_of(sweep, point);
  const bool succeeded = image.state == JobState::succeeded;
  return {
      {"point", point},
      {"absorption", sweep.absorption[place.absorption]},
      {"roughness", sweep.roughness[place.roughness]},
      {"scattering", sweep.scattering[place.scattering]},
      {"absorber", absorber_label(sweep, place.absorber)},
      {"seed", point_seed(sweep, point)},
      {"state", name(image.state)},
      {"samples", stats.is_object() ? stats.value("samples", json()) : json()},
      {"relative_error", stats.is_object() ? stats.value("relative_error", json()) : json()},
      {"error", parsed_or_null(image.error, "the error of a sweep's image")},
      {"image", succeeded ? json(link(status.id) + "/points/" + std::to_string(point) + "/image")
                          : json(nullptr)}};
}

}  // namespace

std::string absorber_label(const Sweep& sweep, std::size_t absorber) {
  const auto* named = std::get_if<std::string>(&sweep.absorbers[absorber]);
  return named != nullptr ? *named : "absorber " + std::to_string(absorber + 1);
}

std::string to_json(const SweepStatus& status) {
  Summary summary;
  json results = json::array();
  results.get_ref<json::array_t&>().resize(status.sweep.point_count());
  for (const SweepImageStatus& image : status.images) {
    summary.counts[static_cast<std::size_t>(image.state)] += image.points.size();
    const json stats = parsed_or_null(image.stats, "the stats of a sweep's image");
    if (image.state == JobState::succeeded) {
      ++(image.cached ? summary.cached : summary.traced);
      if (!image.cached) add_stats(summary, stats);
    }
    for (const std::uint32_t point : image.points)
      results.at(point) = result_object(status, image, stats, point);
  }
  const std::string self = link(status.id);
  json object = life_object(status);
  object["request"] = parsed(canonical_json(status.sweep), "the request of a sweep");
  object["points"] = status.sweep.point_count();
  object["traced_images"] = status.images.size();
  object["counts"] = counts_object(summary.counts);
  object["stats"] = {{"traced_images", summary.traced},
                     {"cached_images", summary.cached},
                     {"seconds", summary.seconds},
                     {"cpu_seconds", summary.cpu_seconds},
                     {"nan_samples", summary.nan_samples}};
  object["results"] = std::move(results);
  object["links"] = {{"self", self},
                     {"events", self + "/events"},
                     {"cancel", self + "/cancel"},
                     {"sheet", self + "/sheet"}};
  return object.dump();
}

std::string sweep_list_json(const std::vector<SweepSummary>& sweeps,
                            const std::optional<std::string>& next_cursor) {
  json list = json::array();
  for (const SweepSummary& sweep : sweeps) {
    json& object = list.emplace_back(life_object(sweep));
    object["points"] = sweep.points;
    object["traced_images"] = sweep.traced_images;
    object["links"] = {{"self", link(sweep.id)}};
  }
  return json{{"sweeps", std::move(list)}, {"next_cursor", value_or_null(next_cursor)}}.dump();
}

}  // namespace translucube::api
