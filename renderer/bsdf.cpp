#include "renderer/bsdf.h"

#include <cmath>

namespace translucube {
namespace {

/// Masking-shadowing of both directions over that of wo alone. Reflection: height-correlated (Heitz
/// 2014, eq. 99); transmission: the directions are on opposite sides, Walter's separable form.
double shadowing_reflected(const Ggx& ggx, Vec3 wo, Vec3 wi) {
  const double lambda_o = ggx.lambda(wo);
  return (1 + lambda_o) / (1 + lambda_o + ggx.lambda(wi));
}
double shadowing_transmitted(const Ggx& ggx, Vec3 wi) { return ggx.g1(wi); }

/// |d m / d wi| of refraction (Walter 2007, eq. 17).
double refraction_jacobian(double wo_m, double wi_m, double eta) {
  const double denominator = wo_m + eta * wi_m;
  return eta * eta * std::fabs(wi_m) / (denominator * denominator);
}

}  // namespace

RoughSample sample_rough(const Ggx& ggx, double eta, Vec3 wo, Sample2 u) {
  RoughSample sample;
  const Vec3 m = ggx.sample_visible(wo, u);
  const double wo_m = dot(wo, m);
  if (wo_m <= 0) return sample;
  const double density = ggx.visible_d(wo, m);
  const double f = fresnel(wo_m, eta);
  if (f > 0) {
    const Vec3 wi = reflect(wo, m);
    if (wi.z > 0)
      sample.reflected = LobeSample{wi, f * shadowing_reflected(ggx, wo, wi), density / (4 * wo_m)};
  }
  if (f < 1) {
    const std::optional<Vec3> wi = refract(wo, m, eta);
    if (wi && wi->z < 0) {
      sample.transmitted = LobeSample{*wi, (1 - f) * shadowing_transmitted(ggx, *wi),
                                      density * refraction_jacobian(wo_m, dot(*wi, m), eta)};
    }
  }
  return sample;
}

LobeValue rough_reflection(const Ggx& ggx, double eta, Vec3 wo, Vec3 wi) {
  if (wi.z <= 0) return {};
  const Vec3 m = normalize(wo + wi);
  const double wo_m = dot(wo, m);
  if (wo_m <= 0) return {};
  const double pdf = ggx.visible_d(wo, m) / (4 * wo_m);
  return {fresnel(wo_m, eta) * shadowing_reflected(ggx, wo, wi) * pdf, pdf};
}

LobeValue rough_transmission(const Ggx& ggx, double eta, Vec3 wo, Vec3 wi) {
  if (wi.z >= 0) return {};
  // Walter 2007, eq. 16: m along wo + eta wi, turned to the macroscopic normal.
  Vec3 m = wo + eta * wi;
  const double norm = length(m);
  if (norm == 0) return {};
  m = m * ((m.z < 0 ? -1 : 1) / norm);
  const double wo_m = dot(wo, m), wi_m = dot(wi, m);
  if (wo_m <= 0 || wi_m >= 0) return {};
  const double pdf = ggx.visible_d(wo, m) * refraction_jacobian(wo_m, wi_m, eta);
  return {(1 - fresnel(wo_m, eta)) * shadowing_transmitted(ggx, wi) * pdf, pdf};
}

DirectionalAlbedo directional_albedo(const Ggx& ggx, double eta, double cos_o) {
  constexpr std::uint32_t n = 4096;
  const Vec3 wo{std::sqrt(std::fmax(0.0, 1 - cos_o * cos_o)), 0, cos_o};
  DirectionalAlbedo albedo;
  for (std::uint32_t i = 0; i < n; ++i) {
    const RoughSample s = sample_rough(ggx, eta, wo, owen_sobol2(i, 0x5eed, 0));
    if (s.reflected) albedo.reflected += s.reflected->weight;
    if (s.transmitted) albedo.transmitted += s.transmitted->weight;
  }
  return {albedo.reflected / n, albedo.transmitted / n};
}

}  // namespace translucube
