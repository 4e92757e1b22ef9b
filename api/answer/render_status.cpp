#include "api/answer/render_status.h"

#include <stdexcept>

#include "api/answer/status_json.h"

namespace translucube::api {
namespace {

using nlohmann::json;

/// What the store keeps as JSON text stands in the answer as it is: to build it anew from values
/// would be most of the work of an answer. Throws std::invalid_argument if it is none.
void append(std::string& object, const char* key, const std::optional<std::string>& text) {
  if (text && !json::accept(*text)) throw std::invalid_argument(std::string("not JSON: ") + key);
  object.insert(object.size() - 1, std::string(",\"") + key + "\":" + text.value_or("null"));
}

json refinement_object(const std::optional<Refinement>& refinement) {
  if (!refinement) return nullptr;
  return {{"triangles", refinement->made},
          {"chord_error", finite_or_null(refinement->chord_error)},
          {"limited", refinement->limited}};
}

json mesh_object(const RenderStats& stats) {
  const std::optional<MeshReport>& mesh = stats.mesh;
  if (!mesh) return nullptr;
  return {{"vertices", mesh->vertices},
          {"triangles", mesh->triangles},
          {"welded_vertices", mesh->welded_vertices},
          {"dropped_triangles", mesh->dropped_triangles},
          {"parts", mesh->parts},
          {"smooth", refinement_object(stats.refinement)}};
}

}  // namespace

std::string to_json(const RenderStatus& status) {
  const std::string self = "/v1/renders/" + status.id;
  json members = life_object(status);
  members["progress"] = progress_object(status.progress);
  members["cached"] = status.cached;
  members["links"] = {{"self", self},
                      {"image", self + "/image"},
                      {"events", self + "/events"},
                      {"cancel", self + "/cancel"}};
  std::string object = members.dump();
  append(object, "request", status.request);
  append(object, "material", status.material);
  append(object, "stats", status.stats);
  append(object, "error", status.error);
  return object;
}

std::string render_list_json(const std::vector<RenderStatus>& renders,
                             const std::optional<std::string>& next_cursor) {
  std::string list = R"({"renders":[)";
  for (const RenderStatus& status : renders) try {
      const std::string told = to_json(status);
      if (list.back() != '[') list += ',';
      list += told;
    } catch (const std::invalid_argument&) {
      // Of a damaged store: the others are told.
    }
  return list + R"(],"next_cursor":)" + value_or_null(next_cursor).dump() + '}';
}

std::string stats_json(const RenderStats& stats) {
  return json{{"mesh", mesh_object(stats)},
              {"samples", stats.samples},
              {"seconds", finite_or_null(stats.seconds)},
              {"cpu_seconds", finite_or_null(stats.cpu_seconds)},
              {"threads", stats.threads},
              {"relative_error", finite_or_null(stats.relative_error)},
              {"transport", stats.transport},
              {"traced_images", stats.traced_images},
              {"nan_samples", stats.nan_samples},
              {"truncated_energy", finite_or_null(stats.truncated_energy)},
              {"camera_inside", stats.camera_inside}}
      .dump();
}

}  // namespace translucube::api
