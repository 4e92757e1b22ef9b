#include "api/request/appearance_request.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "api/base/json_reader.h"
#include "api/request/parse.h"
#include "api/request/request_reader.h"
#include "renderer/slab/spectral.h"

namespace translucube::api {
namespace {

using nlohmann::json;

/// The same material in a render request.
RenderRequest render_request(const AppearanceRequest& request, const Catalog& catalog) {
  RenderRequest render = catalog.defaults;
  render.material = request.material;
  return render;
}

void read_appearance(const json& value, const Catalog& catalog, AppearanceRequest& out,
                     Faults& faults) {
  ObjectReader request(value, "", faults);
  if (const json* material = request.find("material", Presence::required))
    read_material(*material, request.pointer_to("material"), catalog, MaterialPoint::required,
                  out.material, faults);
  if (out.material.oil_film)
    faults.add("/material/oil_film", "covers a part of a body, which a slab has not");
  if (const json* given = request.find("slab", Presence::required)) {
    ObjectReader slab(*given, request.pointer_to("slab"), faults);
    out.thickness_mm = slab.number("thickness_mm", {1e-6, 1e6}, Presence::required).value_or(1);
    slab.refuse_unknown_keys();
  }
  if (const json* given = request.find("quality")) {
    ObjectReader quality(*given, request.pointer_to("quality"), faults);
    if (const auto error = quality.number("standard_error", {1e-5, 1}, Presence::required))
      out.standard_error = *error;
    quality.refuse_unknown_keys();
  }
  if (const auto seed = request.integer("seed", 0, largest_seed)) out.seed = *seed;
  request.refuse_unknown_keys();
}

json shares(const SlabLight& light, const char* direct) {
  return {{direct, light.direct}, {"diffuse", light.diffuse}, {"total", light.total}};
}

json colour(const SlabLight& light) {
  return {{"xyz", light.xyz},
          {"lab", light.lab},
          {"bands", light.bands.empty() ? json(nullptr) : json(light.bands)}};
}

json with_errors(json value, json errors) {
  value["standard_error"] = std::move(errors);
  return value;
}

json incidence(const SlabAppearance::AtIncidence& at) {
  const auto& [value, error] = at;
  return {{"reflectance",
           with_errors(shares(value.reflected, "specular"), shares(error.reflected, "specular"))},
          {"transmittance",
           with_errors(shares(value.transmitted, "regular"), shares(error.transmitted, "regular"))},
          {"reflected", with_errors(colour(value.reflected), colour(error.reflected))},
          {"transmitted", with_errors(colour(value.transmitted), colour(error.transmitted))}};
}

void add_estimate(json& object, const char* key, const std::optional<Estimate>& estimate) {
  object[key] = estimate ? json(estimate->value) : json(nullptr);
  object["standard_error"][key] = estimate ? json(estimate->standard_error) : json(nullptr);
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

SlabAppearance measure(const AppearanceRequest& request, const Catalog& catalog, int threads) {
  const Material material = scene_spec(render_request(request, catalog), catalog).material;
  return slab_appearance(material, request.thickness_mm, request.standard_error, request.seed,
                         threads);
}

std::string appearance_json(const AppearanceRequest& request, const SlabAppearance& appearance,
                            const Catalog& catalog) {
  json answer{
      {"normal", incidence(appearance.normal)},
      {"diffuse", incidence(appearance.diffuse)},
      {"samples", appearance.samples},
      {"seconds", appearance.seconds},
      {"transport", appearance.transport},
      {"largest_standard_error", appearance.largest_standard_error},
      {"seed", request.seed},
      {"slab", {{"thickness_mm", request.thickness_mm}}},
      {"material", json::parse(material_report(render_request(request, catalog), catalog))}};
  json& transmitted = answer["normal"]["transmitted"];
  add_estimate(transmitted, "haze", appearance.haze);
  add_estimate(transmitted, "clarity", appearance.clarity);
  json& borders = answer["bands_nm"] = nullptr;
  if (!appearance.normal.value.reflected.bands.empty()) {
    borders = json::array();
    for (int band = 0; band <= slab_bands; ++band)
      borders.push_back(380 + band * slab_band_width_nm);
  }
  return answer.dump(2) + '\n';
}

}  // namespace translucube::api
