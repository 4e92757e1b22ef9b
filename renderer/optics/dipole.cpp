#include "renderer/optics/dipole.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/optics/fresnel.h"
#include "renderer/optics/wavelengths.h"

namespace translucube {

using std::numbers::pi;

namespace {

/// The positive root t of log(1 + t) + k t = c, for k, c >= 0. Newton's method on a concave rising
/// function, from an upper bound: after the first step it rises to the root.
double solve_radius(double k, double c) {
  double t = k > 0 ? std::fmin(std::expm1(c), c / k) : std::expm1(c);
  for (int i = 0; i < 24; ++i) {
    const double step = (std::log1p(t) + k * t - c) / (1 / (1 + t) + k);
    t -= step;
    if (std::fabs(step) <= 1e-13 * t) break;
  }
  return t;
}

}  // namespace

DipoleProfile::DipoleProfile(double sigma_a, double reduced_sigma_s, double ior) {
  // n^2 (1 - F_dr) = 1 - r_e, with what the interface reflects from outside (lambertian.cpp).
  const double internal = 1 - (1 - diffuse_fresnel_outside(ior)) / (ior * ior);
  const double a = (1 + internal) / (1 - internal);
  const double sigma_t = sigma_a + reduced_sigma_s;
  const bool dense = std::isinf(reduced_sigma_s);
  albedo_ = dense ? 1 : reduced_sigma_s / sigma_t;
  z_ = {1 / sigma_t, (1 + 4.0 / 3 * a) / sigma_t};
  sigma_tr_ = std::sqrt(3 * sigma_a) * std::sqrt(sigma_t);
  // sigma_tr z_r without the difference 1 - alpha'.
  const double k = dense ? 0 : std::sqrt(3 * sigma_a / sigma_t);
  strength_ = {albedo_ / 2 * std::exp(-k), albedo_ / 2 * std::exp(-k * (1 + 4.0 / 3 * a))};
}

double DipoleProfile::reflectance(double r) const {
  double sum = 0;
  for (const double z : z_) {
    const double d = std::sqrt(r * r + z * z);
    sum += z / d * (sigma_tr_ + 1 / d) * std::exp(-sigma_tr_ * d) / d;
  }
  return albedo_ / (4 * pi) * sum;
}

/// Share of a source's light that comes out within r: 1 - (z / d) exp(-sigma_tr (d - z)), written
/// for small r too.
double DipoleProfile::share(int source, double r) const {
  const double z = z_[source];
  if (std::isinf(r)) return 1;
  const double d = std::sqrt(r * r + z * z), deeper = r * r / (d + z);
  return deeper / d - z / d * std::expm1(-sigma_tr_ * deeper);
}

double DipoleProfile::within(double r) const {
  return strength_[0] * share(0, r) + strength_[1] * share(1, r);
}

double DipoleProfile::sample(double u, double reach) const {
  const double first = strength_[0] * share(0, reach), all = within(reach);
  const int source = u * all < first ? 0 : 1;
  const double within_source =
      (u * all - (source == 0 ? 0 : first)) / std::fmax(strength_[source], 1e-300);
  const double q = std::clamp(within_source, 0.0, 1 - 0x1p-53);
  const double z = z_[source];
  const double deeper = z * solve_radius(sigma_tr_ * z, -std::log1p(-q));
  return std::fmin(std::sqrt(deeper * (deeper + 2 * z)), reach);
}

DipoleRadii::DipoleRadii(double reduced_sigma_s, double ior, double reach)
    : profile_(0, reduced_sigma_s, ior), reach_(reach) {
  mass_ = local() ? profile_.total() : profile_.within(reach);
}

DipoleColor::DipoleColor(const Absorber& absorber, double sigma_a_peak, double reduced_sigma_s,
                         double ior, double reach) {
  if (std::isinf(sigma_a_peak)) return;  // black, however dense the scatterers
  const std::vector<Wavelength> wavelengths = wavelengths_of(absorber);
  std::vector<DipoleProfile> profiles;
  profiles.reserve(wavelengths.size());
  for (const Wavelength& w : wavelengths)
    profiles.emplace_back(sigma_a_peak * w.relative_absorption, reduced_sigma_s, ior);
  total_ = color_operator(wavelengths, [&](std::size_t i) { return profiles[i].total(); });
  if (std::isinf(reduced_sigma_s)) return;

  const DipoleProfile clear(0, reduced_sigma_s, ior);
  z_min_ = clear.z_real();
  for (const DipoleProfile& p : profiles) z_min_ = std::fmin(z_min_, p.z_real());
  const int octaves = static_cast<int>(std::ceil(std::log2(1 + reach / z_min_))) + 1;
  table_ = ColorOperatorTable(octaves, [&](double x) {
    const double r = z_min_ * (x - 1), unabsorbed = clear.reflectance(r);
    // So thin a body that nothing is left even in double precision is never sampled.
    return color_operator(wavelengths, [&](std::size_t i) {
      return unabsorbed > 0 ? profiles[i].reflectance(r) / unabsorbed : 0;
    });
  });
}

}  // namespace translucube
