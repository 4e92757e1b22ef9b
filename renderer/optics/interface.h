#pragma once

// The air-material interface. Conventions, said once: `wo` and `wi` both point away from the
// surface; local z is the macroscopic normal on wo's side; `eta` is the index beyond the interface
// over the index on wo's side. Densities are per solid angle of wi. What is carried is basic
// radiance, radiance over the index squared, so that crossing the interface needs no further factor
// (Nicodemus 1963); in terms of Walter's f: f_basic = f eta_i^2 / eta_o^2. `f_cos` is f_basic times
// |cos theta_i|.

#include <variant>

#include "renderer/optics/fresnel.h"
#include "renderer/optics/material.h"
#include "renderer/optics/microfacet.h"

namespace translucube {

struct SmoothInterface {
  static constexpr bool smooth = true;
  double ior = 1.5;
};

struct RoughInterface {
  static constexpr bool smooth = false;
  double ior = 1.5;
  Ggx microfacets;
  bool multiple_scattering = true;  ///< false only where tests compare with renderers that lose it
};

/// Slopes below this are lost in the rounding of directions in single precision, in which many rays
/// cross together: no picture shows them.
inline constexpr double least_alpha = 1e-6;

using AnyInterface = std::variant<SmoothInterface, RoughInterface>;
AnyInterface make_interface(const Material& material);

/// What a body sends to wo of light from a direction wi.
struct LobeValue {
  double f_cos = 0;  ///< f_basic |cos theta_i|
  double pdf = 0;    ///< the density with which the body's own sampling finds wi
};

}  // namespace translucube
