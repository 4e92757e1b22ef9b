#include "renderer/optics/lambertian.h"

#include <algorithm>
#include <numbers>

namespace translucube {

using std::numbers::pi;

InterfacedLambertian::InterfacedLambertian(const SmoothInterface& interface) : ior_(interface.ior) {
  // n^2 (1 - r_i) = 1 - r_e: what can leave must have been able to enter (Saunderson 1942, Elias
  // 2001).
  norm_ = 1 / (pi * (1 - diffuse_fresnel_outside(ior_)));
}

InterfacedLambertian::InterfacedLambertian(const RoughInterface& interface) : ior_(interface.ior) {
  table_.resize(nodes + 1);
  for (int i = 0; i <= nodes; ++i) {
    const double mu = std::max(1e-4, static_cast<double>(i) / nodes);
    table_[i] = static_cast<float>(directional_albedo(interface, ior_, mu).transmitted);
  }
  // As above: 1 - r_i, which is small, straight from inside would carry the noise of r_i many times
  // enlarged. The integral of 2 mu T over the table's linear pieces is exact, so that what enters
  // leaves.
  double entering = 0;
  for (int i = 0; i < nodes; ++i) {
    const double from = table_[i], to = table_[i + 1];
    entering += (from * (3 * i + 1) + to * (3 * i + 2)) / (3.0 * nodes * nodes);
  }
  norm_ = 1 / (pi * entering);
}

double InterfacedLambertian::entering() const { return 1 / (pi * norm_); }

double InterfacedLambertian::transmittance(double mu) const {
  if (table_.empty()) return 1 - fresnel(mu, ior_);
  const double x = mu * nodes;
  const int i = std::min(static_cast<int>(x), nodes - 1);
  return table_[i] + (x - i) * (table_[i + 1] - table_[i]);
}

LobeValue InterfacedLambertian::emit(Vec3 wi) const {
  if (wi.z <= 0) return {};
  return {transmittance(wi.z) * norm_ * wi.z, wi.z / pi};
}

Vec3 InterfacedLambertian::sample(Sample2 u) {
  const double r = std::sqrt(u.u), phi = 2 * pi * u.v;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.u)};
}

}  // namespace translucube
