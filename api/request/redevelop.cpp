#include "api/request/redevelop.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "api/base/json_reader.h"
#include "api/base/text.h"
#include "api/request/canonical.h"
#include "api/request/read_request.h"
#include "api/request/scene_spec.h"
#include "renderer/optics/material_cube.h"

namespace translucube::api {
namespace {

using nlohmann::json;

/// Coefficients of each channel are an absorber of their own, and its density.
void name_absorber(CoefficientsRequest& coefficients, AbsorberRequest& absorber) {
  const auto* channels = std::get_if<0>(&coefficients.sigma_a);
  if (!channels) return;
  const double peak = *std::max_element(channels->begin(), channels->end());
  absorber = peak > 0 ? RgbAbsorber{*channels} : RgbAbsorber{};
  coefficients.sigma_a = peak;
}

void set_absorption(MaterialRequest& material, double absorption) {
  if (auto* cube = std::get_if<CubePoint>(&material.point)) {
    cube->absorption = absorption;
    return;
  }
  auto& coefficients = std::get<CoefficientsRequest>(material.point);
  const double g = material.anisotropy, d = material.reference_thickness_mm;
  const double peak = from_cube({absorption, 0, 0}, g, d).sigma_a_peak;
  if (std::isfinite(peak)) {
    coefficients.sigma_a = peak;
  } else {
    // JSON has no infinity: only the cube can say it.
    CubePoint cube = to_cube({0, coefficients.alpha, coefficients.sigma_s}, g, d);
    cube.absorption = 1;
    material.point = cube;
  }
}

/// A catalog's name, or JSON text of an absorber.
AbsorberRequest read_asked_absorber(const std::string& text, const Catalog& catalog,
                                    Faults& faults) {
  AbsorberRequest absorber;
  json value = text;
  if (text.starts_with('{')) {
    auto read = read_json(text, catalog.limits.body_bytes);
    if (!read) {
      faults.add("?absorber", read.problem().detail);
      return absorber;
    }
    auto& document = *read;
    if (!document.faults.empty()) {
      faults.add("?absorber", document.faults.list().front().detail);
      return absorber;
    }
    value = std::move(document.value);
  }
  read_absorber(value, "?absorber", catalog, absorber, faults);
  return absorber;
}

}  // namespace

std::optional<double> absorption_number(std::string_view text) {
  const auto value = number_of<double>(text);
  if (!value || !(*value >= 0 && *value <= 1)) return std::nullopt;
  return *value + 0.0;  // minus zero is zero
}

Result<Redeveloped> redevelop(std::string_view canonical_request, const Redevelopment& asked,
                              const Catalog& catalog) {
  std::vector<Fault> query_faults;
  AbsorberRequest absorber;
  if (asked.absorber) {
    Faults faults;
    absorber = read_asked_absorber(*asked.absorber, catalog, faults);
    query_faults = faults.list();
  }
  if (asked.absorption && !(*asked.absorption >= 0 && *asked.absorption <= 1))
    query_faults.push_back({"?absorption", "must be a number in [0, 1]"});
  if (!query_faults.empty()) return invalid_query(std::move(query_faults));

  json document = json::parse(canonical_request, nullptr, false);
  if (document.is_discarded() || !document.contains("material") ||
      !document.value("explorable", false)) {
    Problem problem{
        ProblemCode::conflict,
        "Only a render with \"explorable\": true can be developed for another absorber.",
        {}};
    if (asked.absorption) problem.faults.push_back({"?absorption", "the render is not explorable"});
    if (asked.absorber) problem.faults.push_back({"?absorber", "the render is not explorable"});
    return problem;
  }
  RenderRequest request = catalog.defaults;
  Faults faults;
  read_material(document["material"], "/material", catalog, MaterialPoint::required,
                request.material, faults);
  if (!faults.empty()) return invalid_request(faults);
  MaterialRequest& material = request.material;
  if (auto* coefficients = std::get_if<CoefficientsRequest>(&material.point))
    name_absorber(*coefficients, material.absorber);
  if (asked.absorber) material.absorber = std::move(absorber);
  if (asked.absorption) set_absorption(material, *asked.absorption);
  document["material"] = json::parse(canonical_json(request))["material"];
  const Material made = scene_spec(request, catalog).material;
  return Redeveloped{{made.absorber, made.coefficients.sigma_a_peak}, document.dump()};
}

std::string with_samples(std::string_view canonical_request, std::uint32_t samples) {
  json document = json::parse(canonical_request);
  document["quality"] = {{"samples", samples}};
  return document.dump();
}

}  // namespace translucube::api
