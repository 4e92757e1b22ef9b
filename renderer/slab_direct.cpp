#include "renderer/slab_direct.h"

#include <array>
#include <cmath>
#include <numbers>

#include "renderer/fresnel.h"

namespace translucube {
namespace {

constexpr int points = 16;
struct Quadrature {
  std::array<double, points> x{}, weight{};
};

/// Gauss and Legendre's rule on [0, 1], by Newton's method from Chebyshev's points (Abramowitz and
/// Stegun 1964, 25.4.30).
Quadrature gauss_legendre() {
  Quadrature rule;
  for (int i = 0; i < points; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5)), slope = 1;
    for (int step = 0; step < 8; ++step) {
      double p0 = 1, p1 = x;
      for (int k = 2; k <= points; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = points * (x * p1 - p0) / (x * x - 1);
      x -= p1 / slope;
    }
    rule.x[i] = 0.5 * (1 + x);
    rule.weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

}  // namespace

DirectLight direct_light(double ior, double extinction, double mu) {
  const double f = fresnel(mu, ior);
  const double mu_inside = std::sqrt(1 - (1 - mu * mu) / (ior * ior));
  const double e = std::exp(-extinction / mu_inside);
  const double series = (1 - f) * (1 - f) * e / (1 - f * f * e * e);
  return {f + f * e * series, series};
}

DirectLight direct_light_diffuse(double ior, double extinction) {
  // Panels that halve towards grazing, where everything that is steep lies.
  constexpr int panels = 24;
  static const Quadrature rule = gauss_legendre();
  DirectLight sum;
  for (int panel = 0; panel < panels; ++panel) {
    const double high = std::ldexp(1.0, -panel);
    const double low = panel == panels - 1 ? 0 : high / 2;
    for (int i = 0; i < points; ++i) {
      const double mu = low + (high - low) * rule.x[i];
      const double weight = (high - low) * rule.weight[i] * 2 * mu;
      const DirectLight light = direct_light(ior, extinction, mu);
      sum.reflected += weight * light.reflected;
      sum.transmitted += weight * light.transmitted;
    }
  }
  return sum;
}

}  // namespace translucube
