#pragma once

#include <cmath>
#include <numbers>

#include "renderer/base/sampler.h"
#include "renderer/base/vec.h"

namespace translucube {

/// Equal in all directions. Marsaglia (1972): no sine, no cosine.
inline Vec3 sample_isotropic(Rng& rng) {
  while (true) {
    const Sample2 u = rng.uniform2();
    const double a = 2 * u.u - 1, b = 2 * u.v - 1, s = a * a + b * b;
    if (s >= 1) continue;
    const double r = 2 * std::sqrt(1 - s);
    return {a * r, b * r, 1 - 2 * s};
  }
}

/// Cosine between the directions of travel before and after a scattering (Henyey and Greenstein
/// 1941), mean g; inverted from its distribution. `u` in [0, 1).
inline double sample_henyey_greenstein(double g, double u) {
  if (std::fabs(g) < 1e-4) return 2 * u - 1;
  const double q = (1 - g * g) / (1 - g + 2 * g * u);
  return std::fmin(1.0, std::fmax(-1.0, (1 + g * g - q * q) / (2 * g)));
}

/// Density of that cosine's direction, per solid angle.
inline double henyey_greenstein(double g, double cos_theta) {
  const double q = 1 + g * g - 2 * g * cos_theta;
  return (1 - g * g) / (4 * std::numbers::pi * q * std::sqrt(q));
}

/// Homogeneous scatterers in lengths of the body's unit; absorption is developed later, not traced.
struct Medium {
  double sigma_s = 0;  ///< 1 / unit, finite
  double g = 0;

  double sample_flight(Rng& rng) const { return -std::log(rng.uniform_positive()) / sigma_s; }

  /// Density of a turn by this cosine, per solid angle.
  double phase(double cos_theta) const {
    return g == 0 ? 1 / (4 * std::numbers::pi) : henyey_greenstein(g, cos_theta);
  }

  Vec3 scatter(Vec3 direction, Rng& rng) const {
    if (g == 0) return sample_isotropic(rng);
    const Sample2 u = rng.uniform2();
    const double cos_theta = sample_henyey_greenstein(g, u.u);
    const double sin_theta = std::sqrt(std::fmax(0.0, 1 - cos_theta * cos_theta));
    const double phi = 2 * std::numbers::pi * u.v;
    const Vec3 turned = Frame(direction).to_world(
        {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
    return normalize(turned);  // thousands of turns would add up their rounding
  }
};

}  // namespace translucube
