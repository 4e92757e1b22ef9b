#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "renderer/base/color_operator.h"
#include "renderer/optics/material.h"

namespace translucube {

/// Light of one wavelength; for an absorber that is given by R, G, B, one of these channels.
struct Wavelength {
  double relative_absorption;  ///< of the absorber's peak
  /// Its part in the operator from RGB to RGB, row-major: what the spectrum that stands for a
  /// channel (the columns, spectrum.h) has of it under D65 counts this much in R, G, B (the rows).
  /// The parts of all wavelengths add up to the identity.
  std::array<double, 9> share{};
};

std::vector<Wavelength> wavelengths_of(const Absorber& absorber);

/// The operator of something that multiplies the light of wavelength i by `value(i)`.
template <class Value>
ColorOperator color_operator(const std::vector<Wavelength>& wavelengths, Value&& value) {
  std::array<double, 9> sum{};
  for (std::size_t i = 0; i < wavelengths.size(); ++i) {
    const double v = value(i);
    for (int k = 0; k < 9; ++k) sum[k] += wavelengths[i].share[k] * v;
  }
  ColorOperator m;
  for (int k = 0; k < 9; ++k) m[k] = static_cast<float>(sum[k]);
  return m;
}

}  // namespace translucube
