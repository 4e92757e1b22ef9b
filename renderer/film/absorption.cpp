#include "renderer/film/absorption.h"

#include <algorithm>

#include "renderer/base/spectrum.h"

namespace translucube {

SpectralLane::SpectralLane(const SpectralAbsorber& absorber, double sigma_a_peak)
    : sigma_a_peak_(sigma_a_peak) {
  SpectrumTable k;
  double white = 0;  // luminance of the illuminant
  for (int i = 0; i < spectrum_size; ++i) {
    k[i] = relative_absorption(absorber, first_wavelength_nm + i * wavelength_step_nm);
    white += cie_y[i] * cie_d65[i];
  }
  const std::array<const SpectrumTable*, 3> cmf{&cie_x, &cie_y, &cie_z};
  const std::array<const SpectrumTable*, 3> basis{&basis_r, &basis_g, &basis_b};
  constexpr int octaves = 40;
  table_ = ColorOperatorTable(octaves, [&](double x) {
    Matrix3 xyz{};
    for (int i = 0; i < spectrum_size; ++i) {
      const double transmitted = std::exp(-k[i] * (x - 1)) * cie_d65[i] / white;
      for (int row = 0; row < 3; ++row)
        for (int c = 0; c < 3; ++c) xyz[row][c] += (*cmf[row])[i] * (*basis[c])[i] * transmitted;
    }
    ColorOperator m;
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 3; ++c) {
        double rgb = 0;
        for (int j = 0; j < 3; ++j) rgb += xyz_to_rgb[row][j] * xyz[j][c];
        m[3 * row + c] = static_cast<float>(rgb);
      }
    return m;
  });
}

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
