#include "renderer/optics/wavelengths.h"

#include <algorithm>

#include "renderer/base/spectrum.h"

namespace translucube {
namespace {

std::vector<Wavelength> channels_of(const RgbAbsorber& absorber) {
  const double peak = *std::max_element(absorber.relative.begin(), absorber.relative.end());
  std::vector<Wavelength> channels(3);
  for (int c = 0; c < 3; ++c) {
    channels[c].relative_absorption = absorber.relative[c] / peak;
    channels[c].share[4 * c] = 1;
  }
  return channels;
}

}  // namespace

std::vector<Wavelength> wavelengths_of(const Absorber& absorber) {
  if (const auto* rgb = std::get_if<RgbAbsorber>(&absorber)) return channels_of(*rgb);
  const auto& spectral = std::get<SpectralAbsorber>(absorber);
  const std::array<const SpectrumTable*, 3> basis{&basis_r, &basis_g, &basis_b};
  std::vector<Wavelength> wavelengths(spectrum_size);
  for (int i = 0; i < spectrum_size; ++i) {
    wavelengths[i].relative_absorption = relative_absorption(spectral, wavelength_nm(i));
    const std::array<double, 3> rgb = rgb_of_d65(i);
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 3; ++c) wavelengths[i].share[3 * row + c] = rgb[row] * (*basis[c])[i];
  }
  return wavelengths;
}

}  // namespace translucube
