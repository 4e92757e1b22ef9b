#pragma once

#include <cmath>
#include <numbers>

#include "renderer/base/sampler.h"
#include "renderer/base/vec.h"

namespace translucube {

/// Isotropic GGX slopes with Smith masking (Walter et al. 2007, "Microfacet Models for Refraction
/// through Rough Surfaces"). Directions are local, z the macroscopic normal, on wo's side.
struct Ggx {
  double alpha = 0.1;  ///< (0, 1]

  /// Density of normals per projected macroscopic area (Walter 2007, eq. 33).
  double d(Vec3 m) const {
    if (m.z <= 0) return 0;
    const double a2 = alpha * alpha;
    const double q = (m.x * m.x + m.y * m.y) / a2 + m.z * m.z;
    return 1 / (std::numbers::pi * a2 * q * q);
  }

  /// Microfacet area visible from w per macroscopic area, for w on either side of the macroscopic
  /// surface: cos_theta (1 + Lambda(w)) (Heitz et al. 2016, section 4.1; Walter 2007, eq. 34).
  double projected_area(Vec3 w) const {
    const double q = alpha * alpha * (w.x * w.x + w.y * w.y);
    const double root = std::sqrt(w.z * w.z + q);
    return w.z > 0 ? 0.5 * (w.z + root) : 0.5 * q / (root - w.z);  // without cancellation
  }

  /// Density of the normals that w sees, per solid angle (Heitz 2014, eq. 2).
  double visible_d(Vec3 w, Vec3 m) const {
    const double cos_m = dot(w, m);
    return cos_m <= 0 ? 0 : d(m) * cos_m / projected_area(w);
  }

  /// A normal in proportion to visible_d, for w on either side (Dupuy and Benyoub 2023, "Sampling
  /// Visible GGX Normals with Spherical Caps").
  Vec3 sample_visible(Vec3 wo, Sample2 u) const {
    const Vec3 w = normalize({alpha * wo.x, alpha * wo.y, wo.z});
    const double phi = 2 * std::numbers::pi * u.u;
    const double z = (1 - u.v) * (1 + w.z) - w.z;
    const double r = std::sqrt(std::fmax(0.0, 1 - z * z));
    const Vec3 h = Vec3{r * std::cos(phi), r * std::sin(phi), z} + w;
    return normalize({alpha * h.x, alpha * h.y, std::fmax(h.z, 1e-300)});
  }
};

}  // namespace translucube
