#pragma once

// Values of the microsurface's BSDF: of one scattering in closed form, and of all orders as the
// renderer finds light by it.

#include <cmath>
#include <memory>

#include "renderer/optics/fresnel.h"
#include "renderer/optics/microsurface_batch.h"
#include "tests/support/scenes.h"

namespace translucube::test {

inline Vec3 from_angles(double cosine, double phi) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

/// Smith's Lambda of a direction on either side (Walter 2007, eq. 34).
inline double smith_lambda(double alpha, Vec3 w) {
  const double tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
  return 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}

/// The light from wi that a single microfacet sends to wo, on either side, and the density of wi
/// among the directions in which a visible normal reflects or refracts wo (Walter 2007, eqs. 20,
/// 21; masking and shadowing are those of heights in common: Heitz 2014, eqs. 99, 100).
inline LobeValue single_scattering(const Ggx& ggx, double eta, Vec3 wo, Vec3 wi) {
  const bool reflected = wi.z > 0;
  Vec3 m = reflected ? wo + wi : wo + eta * wi;
  const double norm = length(m);
  if (norm == 0) return {};
  m = m * ((m.z < 0 ? -1 : 1) / norm);
  const double wo_m = dot(wo, m), wi_m = dot(wi, m);
  if (wo_m <= 0 || (reflected ? wi_m <= 0 : wi_m >= 0)) return {};
  const double jacobian =
      reflected ? 1 / (4 * wo_m)
                : eta * eta * std::fabs(wi_m) / ((wo_m + eta * wi_m) * (wo_m + eta * wi_m));
  const double lambda_o = smith_lambda(ggx.alpha, wo), lambda_i = smith_lambda(ggx.alpha, wi);
  const double pdf = ggx.d(m) * wo_m / (wo.z * (1 + lambda_o)) * jacobian;
  const double escape = (1 + lambda_o) * (reflected ? 1 / (1 + lambda_o + lambda_i)
                                                    : std::beta(1 + lambda_o, 1 + lambda_i));
  const double f = fresnel(wo_m, eta);
  return {(reflected ? f : 1 - f) * escape * pdf, pdf};
}

/// f_basic (interface.h) with all orders of scattering: what the renderer's crossings find of a
/// light from wi alone, so dense that none of it is left to chance.
inline Measured bsdf(const Ggx& ggx, double eta, Vec3 wo, Vec3 wi, std::uint64_t key,
                     int walks = 400'000) {
  constexpr float density = 1e9f;
  LightList light;
  for (std::size_t i = 0; i < LightList::size; ++i) light.direction.set(i, wi);
  light.pdf.fill(density);
  light.radiance.assign(LightList::size, {1, 1, 1});
  const BatchInterface interface { float(ggx.alpha), float(eta), wi.z > 0 };
  auto batch = std::make_unique<MicrosurfaceBatch>();
  double sum = 0, squares = 0;
  Rng rng(key);
  int n = 0;
  for (; n < walks; n += MicrosurfaceBatch::capacity) {
    std::array<double, MicrosurfaceBatch::capacity> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      batch->push({0, 0, 1}, -wo, rng.uniform2(), rng.bits());
    batch->start(interface);
    while (batch->under_way() > 0) {
      batch->collide(interface, light, 1);
      const MicrosurfaceBatch::Lit& lit = batch->lit();
      for (std::size_t i = 0; i < lit.size; ++i)
        values[lit.slot[i]] += double(lit.share[i]) * density / std::fabs(wi.z);
    }
    for (const double value : values) sum += value, squares += value * value;
  }
  const double mean = sum / n;
  return {mean, std::sqrt((squares / n - mean * mean) / n)};
}

}  // namespace translucube::test
