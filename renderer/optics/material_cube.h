#pragma once

#include "renderer/optics/material.h"

namespace translucube {

/// Cube coordinates to coefficients (docs/design.md section 1), with d the reference thickness [mm]:
///   sigma_a,peak = -ln(1 - a) / d,   alpha = r^2,   sigma_s (1 - g) = 4/3 s / (1 - s) / d.
/// Both ends are closed: a = 1 and s = 1 give +infinity.
/// The scattering law is the two-stream diffuse reflectance s = 3/4 tau' / (1 + 3/4 tau') of a
/// non-absorbing slab of reduced optical thickness tau' = sigma_s (1 - g) d.
/// Expects coordinates in [0, 1], g in (-1, 1), d > 0.
Coefficients from_cube(const CubePoint& point, double g, double reference_thickness_mm);

/// The inverse of from_cube.
CubePoint to_cube(const Coefficients& coefficients, double g, double reference_thickness_mm);

/// What a person asks of a material beside its coefficients; infinite where there is no event.
struct DerivedOptics {
  double mean_free_path_mm = 0;            ///< 1 / (sigma_s + sigma_a,peak)
  double transport_mean_free_path_mm = 0;  ///< 1 / (sigma_s (1 - g) + sigma_a,peak)
  double albedo_at_peak = 0;               ///< sigma_s / (sigma_s + sigma_a,peak), 0 where empty
};
DerivedOptics derived_optics(const Coefficients& coefficients, double g);

}  // namespace translucube
