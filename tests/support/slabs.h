#pragma once

// Flat slabs to measure, and what to read of them.

#include "renderer/slab/appearance.h"

namespace translucube::test {

/// Coefficients for a slab of 1 mm.
inline Material plate(double ior, double alpha, double sigma_s, double sigma_a = 0, double g = 0) {
  Material m;
  m.coefficients = {sigma_a, alpha, sigma_s};
  m.ior = ior;
  m.g = g;
  return m;
}

inline SlabAppearance measure(const Material& m, double standard_error = 1e-3,
                              std::uint64_t seed = 1) {
  return slab_appearance(m, 1, standard_error, seed, 0);
}

inline double reflectance(const SlabAppearance::AtIncidence& at) {
  return at.value.reflected.total[1];
}
inline double transmittance(const SlabAppearance::AtIncidence& at) {
  return at.value.transmitted.total[1];
}
inline double reflectance_error(const SlabAppearance::AtIncidence& at) {
  return at.standard_error.reflected.total[1];
}
inline double transmittance_error(const SlabAppearance::AtIncidence& at) {
  return at.standard_error.transmitted.total[1];
}

}  // namespace translucube::test
