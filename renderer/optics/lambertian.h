#pragma once

// The interfaced Lambertian body (Elias, Simonot, Menu 2001): light crosses the interface, is
// reflected without loss by a perfectly diffusing background right below it, and crosses back, with
// all inter-reflections between background and interface summed in closed form. The s = 1 edge of
// the cube.

#include <cmath>
#include <vector>

#include "renderer/base/sampler.h"
#include "renderer/optics/interface.h"
#include "renderer/optics/microsurface.h"

namespace translucube {

class InterfacedLambertian {
 public:
  InterfacedLambertian() = default;
  explicit InterfacedLambertian(const SmoothInterface& interface);
  explicit InterfacedLambertian(const RoughInterface& interface);

  // The part of light from wo that went through the body, without the interface's own reflection,
  // is T(mu_o) T(mu_i) / (pi n^2 (1 - r_i)), r_i the diffuse internal reflectance of the interface.

  /// T, the share of light from mu that crosses the interface.
  double transmittance(double mu) const;
  /// The part of that light that comes back towards wi: T(mu_i) / (pi n^2 (1 - r_i)). In all
  /// directions it is all of it: the integral over wi is 1 to rounding.
  LobeValue emit(Vec3 wi) const;
  /// Cosine-distributed; density mu_i / pi.
  static Vec3 sample(Sample2 u);
  /// Share of diffuse light from outside that crosses the interface: 1 - r_e = n^2 (1 - r_i).
  double entering() const;

 private:
  static constexpr int nodes = 128;

  double ior_ = 1.5, norm_ = 0;
  std::vector<float> table_;  ///< T over mu in [0, 1] for a rough interface; empty: Fresnel
};

}  // namespace translucube
