#pragma once

#include <cmath>
#include <optional>

#include "renderer/base/vec.h"

namespace translucube {

/// Unpolarised reflectance of a smooth dielectric. `cos_o` >= 0 on the side where the light path
/// arrives, `eta` = index beyond / index on this side (Fresnel 1823; Born and Wolf, section 1.5.3).
inline double fresnel(double cos_o, double eta) {
  if (eta == 1) return 0;
  const double sin2_t = (1 - cos_o * cos_o) / (eta * eta);
  if (sin2_t >= 1) return 1;
  const double cos_t = std::sqrt(1 - sin2_t);
  const double s = (cos_o - eta * cos_t) / (cos_o + eta * cos_t);
  const double p = (eta * cos_o - cos_t) / (eta * cos_o + cos_t);
  return 0.5 * (s * s + p * p);
}

/// Mirror direction of `wo` (pointing away from the surface) about `m`.
inline Vec3 reflect(Vec3 wo, Vec3 m) { return (2 * dot(wo, m)) * m - wo; }

/// Refracted direction of `wo` beyond the interface with normal `m` on wo's side (Snell); empty at
/// total internal reflection.
inline std::optional<Vec3> refract(Vec3 wo, Vec3 m, double eta) {
  const double cos_o = dot(wo, m);
  const double sin2_t = (1 - cos_o * cos_o) / (eta * eta);
  if (sin2_t >= 1) return {};
  const double cos_t = std::sqrt(1 - sin2_t);
  return (cos_o / eta - cos_t) * m - wo * (1 / eta);
}

/// Reflectance of diffuse light from outside a smooth body: 2 int F(mu) mu dmu, by the midpoint
/// rule in mu (error < 1e-6 for ior in [1, 4]).
inline double diffuse_fresnel_outside(double ior) {
  constexpr int n = 2048;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double mu = (i + 0.5) / n;
    sum += fresnel(mu, ior) * mu;
  }
  return 2 * sum / n;
}

}  // namespace translucube
