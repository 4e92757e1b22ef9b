#include "api/answer/material_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "api/answer/status_json.h"
#include "api/request/scene_spec.h"
#include "renderer/base/spectrum.h"
#include "renderer/film/absorption.h"
#include "renderer/optics/material_cube.h"

namespace translucube::api {
namespace {

using nlohmann::json;

/// Linear Rec.709 of D65 light after `d` mm of the absorber (Beer-Lambert-Bouguer), white = 1.
/// sigma_a_peak is finite.
std::array<double, 3> color_through(const RgbAbsorber& absorber, double sigma_a_peak, double d) {
  std::array<double, 3> rgb;
  for (int c = 0; c < 3; ++c) rgb[c] = std::exp(-sigma_a_peak * absorber.relative[c] * d);
  return rgb;
}

std::array<double, 3> color_through(const SpectralAbsorber& absorber, double sigma_a_peak,
                                    double d) {
  std::array<double, 3> xyz{};
  double white = 0;
  for (int i = 0; i < spectrum_size; ++i) {
    const double wavelength_nm = first_wavelength_nm + i * wavelength_step_nm;
    const double transmitted =
        std::exp(-sigma_a_peak * relative_absorption(absorber, wavelength_nm) * d) * cie_d65[i];
    xyz[0] += cie_x[i] * transmitted;
    xyz[1] += cie_y[i] * transmitted;
    xyz[2] += cie_z[i] * transmitted;
    white += cie_y[i] * cie_d65[i];
  }
  std::array<double, 3> rgb{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      rgb[row] += xyz_to_rgb[row][column] * xyz[column] / white;
  return rgb;
}

/// A body with an infinite absorber is black for every wavelength, also where the spectrum is zero:
/// the axis ends in the black body (docs/design.md section 1).
std::array<double, 3> color_through_reference(const Material& material, double d) {
  if (std::isinf(material.coefficients.sigma_a_peak)) return {0, 0, 0};
  return std::visit(
      [&](const auto& absorber) {
        return color_through(absorber, material.coefficients.sigma_a_peak, d);
      },
      material.absorber);
}

json coefficients_json(const Material& material) {
  const Coefficients& coefficients = material.coefficients;
  json object{{"sigma_a_peak", finite_or_null(coefficients.sigma_a_peak)},
              {"alpha", coefficients.alpha},
              {"sigma_s", finite_or_null(coefficients.sigma_s)},
              {"g", material.g},
              {"ior", material.ior}};
  if (const auto* rgb = std::get_if<RgbAbsorber>(&material.absorber)) {
    json& channels = object["sigma_a"] = json::array();
    for (const double relative : rgb->relative)
      channels.push_back(finite_or_null(coefficients.sigma_a_peak * relative));
  }
  return object;
}

}  // namespace

std::string material_report(const RenderRequest& request, const Catalog& catalog) {
  const Material material = scene_spec(request, catalog).material;
  const double d = request.material.reference_thickness_mm;
  // The cube as it was given where it was: no rounding from going there and back.
  const auto* given = std::get_if<CubePoint>(&request.material.point);
  const CubePoint cube = given ? *given : to_cube(material.coefficients, material.g, d);
  DerivedOptics optics = derived_optics(material.coefficients, material.g);
  // Pigments keep their albedo at any density, none and infinite included.
  if (material.absorption_per_scattering)
    optics.albedo_at_peak = 1 / (1 + *material.absorption_per_scattering);
  return json{{"cube",
               {{"absorption", cube.absorption},
                {"roughness", cube.roughness},
                {"scattering", cube.scattering}}},
              {"coefficients", coefficients_json(material)},
              {"reference_thickness_mm", d},
              {"mean_free_path_mm", finite_or_null(optics.mean_free_path_mm)},
              {"transport_mean_free_path_mm", finite_or_null(optics.transport_mean_free_path_mm)},
              {"albedo", optics.albedo_at_peak},
              {"color_through_reference", color_through_reference(material, d)}}
      .dump();
}

}  // namespace translucube::api
