#pragma once

#include <cmath>

#include "renderer/base/batch.h"

namespace translucube {

/// Scattering vertices inside the unit sphere, each with a light that is looked for from there.
struct VertexBatch : Batch<256> {
  Vectors up{};     ///< outward radius, unit
  Floats depth2{};  ///< 1 - rho^2, rho the distance from the centre
  Vectors d{};      ///< inside, unit: of travel before the vertex, or from it
  Vectors light{};  ///< towards the light, unit

  /// The number of the new vertex, at p; `depth_squared`: 1 - |p|^2. Room for one more is the
  /// caller's care.
  std::size_t push(Vec3 p, double depth_squared, Vec3 inside, Vec3 towards) {
    const std::size_t i = size++;
    up.set(i, p * (1 / std::fmax(length(p), 1e-12)));
    depth2[i] = static_cast<float>(depth_squared);
    d.set(i, inside);
    light.set(i, towards);
    return i;
  }
  Vec3 vertex(std::size_t i) const { return std::sqrt(1.0 - depth2[i]) * up[i]; }
};

}  // namespace translucube
