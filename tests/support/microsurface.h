#pragma once

// Values of the microsurface's BSDF, averaged over the walks between its microfacets.

#include <cmath>

#include "renderer/optics/microsurface.h"
#include "tests/support/scenes.h"

namespace translucube::test {

inline Vec3 from_angles(double cosine, double phi) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

/// f_basic (bsdf.h) with all orders of scattering.
inline Estimate bsdf(const Ggx& ggx, double eta, Vec3 wo, Vec3 wi, std::uint64_t key,
                     int walks = 40'000) {
  double sum = 0, squares = 0;
  Rng rng(key);
  for (int i = 0; i < walks; ++i) {
    MicroVertex vertex(ggx, eta, wo, rng.uniform_positive());
    double value = 0;
    while (vertex.weight() > 0) {
      value += vertex.weight() * vertex.evaluate(wi).f_cos / std::fabs(wi.z);
      const MicroSample s = vertex.sample(rng.uniform2());
      vertex.advance(s, rng.uniform_positive(), rng.uniform_positive());
      if (vertex.weight() < 0.25) {
        if (rng.uniform() * 0.25 >= vertex.weight()) break;
        vertex.set_weight(0.25);
      }
    }
    sum += value;
    squares += value * value;
  }
  const double mean = sum / walks;
  return {mean, std::sqrt((squares / walks - mean * mean) / walks)};
}

}  // namespace translucube::test
