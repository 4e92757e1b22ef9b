#include "renderer/absorption.h"

#include <algorithm>

#include "renderer/spectrum.h"

namespace translucube {

double relative_absorption(const SpectralAbsorber& absorber, double wavelength_nm) {
  const auto& w = absorber.wavelengths_nm;
  const auto& v = absorber.values;
  const auto next = std::upper_bound(w.begin(), w.end(), wavelength_nm);
  double value;
  if (next == w.begin()) {
    value = v.front();
  } else if (next == w.end()) {
    value = v.back();
  } else {
    const std::size_t i = next - w.begin();
    const double t = (wavelength_nm - w[i - 1]) / (w[i] - w[i - 1]);
    value = v[i - 1] + t * (v[i] - v[i - 1]);
  }
  return value / *std::max_element(v.begin(), v.end());
}

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

}  // namespace translucube
