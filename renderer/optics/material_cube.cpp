#include "renderer/optics/material_cube.h"

#include <cmath>
#include <limits>

namespace translucube {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// 1 / sum; no event has an infinite path, an infinite coefficient a zero one.
double mean_free_path(double sigma_s, double sigma_a) { return 1.0 / (sigma_s + sigma_a); }

}  // namespace

Coefficients from_cube(const CubePoint& point, double g, double reference_thickness_mm) {
  const double d = reference_thickness_mm;
  Coefficients coefficients;
  // 0 - x rather than -x: no minus zero for the clear body.
  coefficients.sigma_a_peak = 0.0 - std::log1p(-point.absorption) / d;
  coefficients.alpha = point.roughness * point.roughness;
  const double s = point.scattering;
  coefficients.sigma_s = s == 1 ? infinity : 4.0 / 3.0 * s / (1.0 - s) / d / (1.0 - g);
  return coefficients;
}

CubePoint to_cube(const Coefficients& coefficients, double g, double reference_thickness_mm) {
  const double d = reference_thickness_mm;
  CubePoint point;
  point.absorption = 0.0 - std::expm1(-coefficients.sigma_a_peak * d);
  point.roughness = std::sqrt(coefficients.alpha);
  const double tau = 0.75 * coefficients.sigma_s * (1.0 - g) * d;
  // The two forms of t / (1 + t), each without overflow in its half.
  point.scattering = tau <= 1 ? tau / (1.0 + tau) : 1.0 / (1.0 + 1.0 / tau);
  return point;
}

DerivedOptics derived_optics(const Coefficients& coefficients, double g) {
  const double sigma_a = coefficients.sigma_a_peak, sigma_s = coefficients.sigma_s;
  DerivedOptics optics;
  optics.mean_free_path_mm = mean_free_path(sigma_s, sigma_a);
  optics.transport_mean_free_path_mm = mean_free_path(sigma_s * (1.0 - g), sigma_a);
  // A body infinite in both is black: absorption wins, as there is no limit (docs/design.md section 1).
  if (sigma_s > 0 && !std::isinf(sigma_a))
    optics.albedo_at_peak = std::isinf(sigma_s) ? 1.0 : sigma_s / (sigma_s + sigma_a);
  return optics;
}

}  // namespace translucube
