#include "renderer/slab/direct.h"

#include <cmath>

#include "renderer/base/quadrature.h"
#include "renderer/optics/fresnel.h"

namespace translucube::slab {

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

FirstScatterer sample_first_scatterer(double ior, double sigma_s, double mu_outside, double u) {
  const double mu = std::sqrt(1 - (1 - mu_outside * mu_outside) / (ior * ior));
  const double reflectance = fresnel(mu_outside, ior);
  const double scattered = -std::expm1(-sigma_s / mu);
  const double again = reflectance * (1 - scattered);
  const double weight = (1 - reflectance) * scattered / (1 - again);
  if (!(weight > 0)) return {};
  // A geometric series of crossings. One number tells the crossing and, stretched, the place on it.
  u = std::fmax(u, 0x1p-33);
  double crossings = 0;
  if (u < again) {
    crossings = std::floor(std::log(u) / std::log(again));
    u = std::fmin(1.0, u / std::pow(again, crossings));
  }
  u = std::fmin(1.0, std::fmax(0.0, (u - again) / (1 - again)));
  const double path = std::fmin(1 / mu, -std::log1p(-u * scattered) / sigma_s);
  const bool forwards = std::fmod(crossings, 2) == 0;
  return {weight, forwards ? path * mu : 1 - path * mu, forwards ? mu : -mu, crossings / mu + path};
}

}  // namespace translucube::slab
