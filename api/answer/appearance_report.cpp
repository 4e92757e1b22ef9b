#include "api/answer/appearance_report.h"

#include <nlohmann/json.hpp>

#include "api/answer/material_report.h"
#include "renderer/slab/spectral.h"

namespace translucube::api {
namespace {

using nlohmann::json;

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

void add_estimate(json& object, const char* key,
                  const std::optional<SlabAppearance::Estimate>& estimate) {
  object[key] = estimate ? json(estimate->value) : json(nullptr);
  object["standard_error"][key] = estimate ? json(estimate->standard_error) : json(nullptr);
}

}  // namespace

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
