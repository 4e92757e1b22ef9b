#include "renderer/optics/material.h"

#include <algorithm>

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

}  // namespace translucube
