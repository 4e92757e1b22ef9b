#include "api/request/appearance_request.h"

#include <nlohmann/json.hpp>

#include "api/base/json_reader.h"
#include "api/request/read_request.h"

namespace translucube::api {
namespace {

using nlohmann::json;

void read_appearance(const json& value, const Catalog& catalog, AppearanceRequest& out,
                     Faults& faults) {
  FieldReader request(value, "", faults);
  if (const json* material = request.find("material", Presence::required))
    read_material(*material, request.pointer_to("material"), catalog, MaterialPoint::required,
                  out.material, faults);
  if (out.material.oil_film)
    faults.add("/material/oil_film", "covers a part of a body, which a slab has not");
  if (const json* given = request.find("slab", Presence::required)) {
    FieldReader slab(*given, request.pointer_to("slab"), faults);
    out.thickness_mm = slab.number("thickness_mm", {1e-6, 1e6}, Presence::required).value_or(1);
    slab.refuse_unknown_keys();
  }
  if (const json* given = request.find("quality")) {
    FieldReader quality(*given, request.pointer_to("quality"), faults);
    if (const auto error = quality.number("standard_error", {1e-5, 1}, Presence::required))
      out.standard_error = *error;
    quality.refuse_unknown_keys();
  }
  if (const auto seed = request.integer("seed", 0, largest_seed)) out.seed = *seed;
  request.refuse_unknown_keys();
}

}  // namespace

Result<AppearanceRequest> parse_appearance_request(std::string_view text, const Catalog& catalog) {
  auto read = read_json(text, catalog.limits.body_bytes);
  if (!read) return read.problem();
  auto& [value, faults] = *read;
  AppearanceRequest request;
  request.material = catalog.defaults.material;
  request.material.oil_film.reset();
  request.seed = catalog.defaults.seed;
  read_appearance(value, catalog, request, faults);
  if (!faults.empty()) return invalid_request(faults);
  return request;
}

RenderRequest render_request(const AppearanceRequest& request, const Catalog& catalog) {
  RenderRequest render = catalog.defaults;
  render.material = request.material;
  return render;
}

}  // namespace translucube::api
