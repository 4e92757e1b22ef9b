#include "tests/bench/figures/figure.h"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "api/request/canonical.h"
#include "api/request/parse.h"
#include "api/request/scene_spec.h"
#include "api/request/sweep.h"
#include "renderer/film/film.h"
#include "renderer/light/environment_cache.h"
#include "renderer/render.h"

namespace translucube::figures {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::array axis_keys{"columns", "rows", "layers"};

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file.string() + " cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

json read_index(const fs::path& folder) {
  return json::parse(read_text(folder / "index.json")).at("figures");
}

json index_entry(const Figure& figure, const fs::path& folder) {
  const json index = read_index(folder);
  for (const json& entry : index)
    if (entry["name"] == figure.name) return entry;
  throw std::runtime_error("no figure " + figure.name);
}

template <class T>
T accepted(api::Result<T> parsed, const std::string& file) {
  if (!parsed) throw std::runtime_error(file + ": " + to_text(parsed.problem()));
  return *std::move(parsed);
}

RenderResult traced(const SceneSpec& spec, const Quality& quality, EnvironmentCache& environments,
                    const Rendering& how) {
  RenderResult result = render(*build_scene(spec, &environments),
                               how.samples > 0 ? SampleTarget{how.samples} : quality, how.threads);
  if (result.stats.nan_samples > 0) throw std::runtime_error("samples that are not finite");
  return result;
}

/// The coordinate of a sweep's point on the axis of this name.
int coordinate(const api::SweepPlace& place, const std::string& axis) {
  if (axis == "absorption") return static_cast<int>(place.absorption);
  if (axis == "roughness") return static_cast<int>(place.roughness);
  if (axis == "scattering") return static_cast<int>(place.scattering);
  return static_cast<int>(place.absorber);
}

Pictures render_sweep(const json& entry, const std::string& text, const Rendering& how) {
  const api::Catalog& catalog = how.catalog;
  const auto sweep = accepted(api::parse_sweep_request(text, catalog), entry["sweep"]);
  Pictures pictures{{}, api::canonical_json(sweep)};
  EnvironmentCache environments;
  for (const auto& points : api::traced_images(sweep, catalog.limits)) {
    std::vector<api::RenderRequest> lanes;
    for (const std::size_t point : points) lanes.push_back(api::point_request(sweep, point));
    const RenderResult result =
        traced(api::scene_spec(lanes, catalog), sweep.base.quality, environments, how);
    for (std::size_t lane = 0; lane < points.size(); ++lane) {
      Picture picture{{}, develop(result.film, static_cast<int>(lane))};
      for (std::size_t axis = 0; axis < axis_keys.size(); ++axis)
        if (entry.contains(axis_keys[axis]))
          picture.place[axis] =
              coordinate(api::place_of(sweep, points[lane]), entry[axis_keys[axis]]["axis"]);
      pictures.list.push_back(std::move(picture));
    }
  }
  return pictures;
}

Pictures render_steps(const json& entry, const std::string& text, const Rendering& how) {
  const auto steps = [&](const char* axis) {
    return entry.contains(axis) ? entry[axis]["steps"] : json::array({{{"patch", json::object()}}});
  };
  Pictures pictures;
  EnvironmentCache environments;
  const json columns = steps("columns"), rows = steps("rows");
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t column = 0; column < columns.size(); ++column) {
      json request = json::parse(text);
      request.merge_patch(columns[column]["patch"]);
      request.merge_patch(rows[row]["patch"]);
      const auto parsed =
          accepted(api::parse_render_request(request.dump(), how.catalog), entry["request"]);
      const RenderResult result =
          traced(api::scene_spec(parsed, how.catalog), parsed.quality, environments, how);
      pictures.list.push_back(
          {{static_cast<int>(column), static_cast<int>(row), 0}, develop(result.film)});
    }
  pictures.request = entry.dump();
  return pictures;
}

}  // namespace

std::vector<Figure> load_figures(const fs::path& folder) {
  std::vector<Figure> figures;
  const json index = read_index(folder);
  for (const json& entry : index) {
    Figure figure;
    figure.name = entry["name"];
    figure.title = entry["title"];
    figure.caption = entry["caption"];
    figure.see = entry["see"];
    figure.request = entry.contains("sweep") ? entry["sweep"] : entry["request"];
    if (entry.value("layout", "sheet") == "cube") figure.layout = Layout::cube;
    figure.cell_size = entry.value("cell_px", figure.cell_size);
    for (std::size_t axis = 0; axis < axis_keys.size(); ++axis) {
      const json given = entry.value(axis_keys[axis], json::object());
      const json labels = given.value("labels", json::array()),
                 steps = given.value("steps", json::array());
      figure.axes[axis].title = given.value("title", "");
      for (const json& label : labels) figure.axes[axis].labels.push_back(label);
      for (const json& step : steps) figure.axes[axis].labels.push_back(step["label"]);
      if (figure.axes[axis].labels.empty()) figure.axes[axis].labels.emplace_back();
    }
    figures.push_back(std::move(figure));
  }
  return figures;
}

Pictures render_figure(const Figure& figure, const Rendering& how) {
  const json entry = index_entry(figure, how.folder);
  const std::string text = read_text(how.folder / figure.request);
  return entry.contains("sweep") ? render_sweep(entry, text, how) : render_steps(entry, text, how);
}

}  // namespace translucube::figures
