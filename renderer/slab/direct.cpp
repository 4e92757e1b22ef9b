#include "renderer/slab/direct.h"

#include <cmath>

#include "renderer/base/quadrature.h"
#include "renderer/optics/fresnel.h"

namespace translucube {

DirectLight direct_light(double ior, double extinction, double mu) {
  const double f = fresnel(mu, ior);
  const double mu_inside = std::sqrt(1 - (1 - mu * mu) / (ior * ior));
  const double e = std::exp(-extinction / mu_inside);
  const double series = (1 - f) * (1 - f) * e / (1 - f * f * e * e);
  return {f + f * e * series, series};
}

DirectLight direct_light_diffuse(double ior, double extinction) {
  // Panels that halve towards grazing, where everything that is steep lies.
  constexpr int panels = 24, points = 16;
  static const Quadrature rule = gauss_legendre(points);
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
