#include "renderer/film/absorption.h"

#include <algorithm>

#include "renderer/optics/wavelengths.h"

namespace translucube {

namespace {

ColorOperatorTable operators_of(const SpectralAbsorber& absorber) {
  const std::vector<Wavelength> wavelengths = wavelengths_of(absorber);
  constexpr int octaves = 40;
  return ColorOperatorTable(octaves, [&](double x) {
    return color_operator(wavelengths, [&](std::size_t i) {
      return std::exp(-wavelengths[i].relative_absorption * (x - 1));
    });
  });
}

}  // namespace

SpectralLane::SpectralLane(const SpectralAbsorber& absorber, double sigma_a_peak)
    : SpectralLane(sigma_a_peak, operators_of(absorber)) {}

Lane make_lane(const Absorber& absorber, double peak) {
  if (peak == 0) return ClearLane{};
  // All of the light, also where the spectrum is 0: there it has no limit, and absorption wins.
  if (std::isinf(peak)) return OpaqueLane{};
  if (const auto* spectral = std::get_if<SpectralAbsorber>(&absorber))
    return SpectralLane(*spectral, peak);
  const auto& relative = std::get<RgbAbsorber>(absorber).relative;
  const double largest = *std::max_element(relative.begin(), relative.end());
  RgbLane lane;
  for (int c = 0; c < 3; ++c) lane.sigma_a[c] = static_cast<float>(peak * relative[c] / largest);
  return lane;
}

Lane make_lane(const Material& material, const AnyInterior& interior, double unit_mm) {
  if (std::holds_alternative<DensePigmentInterior>(interior))
    return make_lane(material.absorber, *material.absorption_per_scattering);
  const double sigma_a_peak = material.coefficients.sigma_a_peak;
  // Light that only touches an opaque body has no length inside it, or hardly any.
  return !is_open(interior) && !std::isinf(sigma_a_peak)
             ? ClearLane{}
             : make_lane(material.absorber, sigma_a_peak * unit_mm);
}

}  // namespace translucube
