#include "renderer/slab/spectral.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/spectrum.h"
#include "renderer/slab/appearance.h"

namespace translucube::slab {
namespace {

Channels grey(double sigma_a) {
  return {{sigma_a}, std::vector<std::vector<double>>(3 + slab_bands, {1.0})};
}

Channels channels_of(const RgbAbsorber& absorber, double peak) {
  const auto& relative = absorber.relative;
  const double largest = *std::max_element(relative.begin(), relative.end());
  Channels channels;
  for (int c = 0; c < 3; ++c) {
    channels.sigma_a.push_back(peak * relative[c] / largest);
    channels.readouts.push_back({0, 0, 0});
    channels.readouts[c][c] = 1;
  }
  return channels;
}

Channels channels_of(const SpectralAbsorber& absorber, double peak) {
  Channels channels;
  channels.readouts.assign(3 + slab_bands, std::vector<double>(spectrum_size, 0));
  constexpr int steps = static_cast<int>(slab_band_width_nm / wavelength_step_nm);
  for (int i = 0; i < spectrum_size; ++i) {
    channels.sigma_a.push_back(peak * relative_absorption(absorber, wavelength_nm(i)));
    const std::array<double, 3> rgb = rgb_of_d65(i);
    for (int row = 0; row < 3; ++row) channels.readouts[row][i] = rgb[row];
  }
  for (int band = 0; band < slab_bands; ++band)  // the trapezoid rule
    for (int i = 0; i <= steps; ++i)
      channels.readouts[3 + band][band * steps + i] = (i == 0 || i == steps ? 0.5 : 1.0) / steps;
  return channels;
}

}  // namespace

std::vector<double> Channels::read(const std::vector<double>& of_channels) const {
  std::vector<double> values;
  for (const std::vector<double>& row : readouts) {
    double sum = 0;
    for (std::size_t i = 0; i < row.size(); ++i) sum += row[i] * of_channels[i];
    values.push_back(sum);
  }
  return values;
}

Channels make_channels(const Material& material, double thickness_mm) {
  const Coefficients& c = material.coefficients;
  const double peak = c.sigma_a_peak * thickness_mm;
  if (std::isinf(peak)) return grey(peak);
  if (std::isinf(c.sigma_s) || peak == 0) return grey(0);
  return std::visit([&](const auto& absorber) { return channels_of(absorber, peak); },
                    material.absorber);
}

}  // namespace translucube::slab
