#include "renderer/optics/microsurface.h"

#include <cmath>

namespace translucube {
namespace {

Vec3 mirrored(Vec3 w) { return {w.x, w.y, -w.z}; }

}  // namespace

MicroVertex::MicroVertex(const Ggx& ggx, double eta, Vec3 wo, double u)
    : ggx_(ggx), eta_(eta), w_(wo), depth_(-std::log(u) / collision_rate(ggx, -wo)) {}

MicroSample MicroVertex::sample(Sample2 u) const {
  MicroSample s;
  const Vec3 m = ggx_.sample_visible(w_, u);
  const double w_m = dot(w_, m);
  if (w_m <= 0) {  // rounding at grazing incidence: pass as if reflected
    s.reflected = {w_, 1, 0};
    return s;
  }
  const double f = fresnel(w_m, eta_);
  const Vec3 up = reflect(w_, m);
  s.reflected = {up, f, escape_from(ggx_, up, depth_)};
  if (const auto down = refract(w_, m, eta_))
    s.transmitted = {*down, 1 - f, escape_from(ggx_, mirrored(*down), depth_beyond(depth_))};
  return s;
}

void MicroVertex::advance(const MicroSample& s, double u, double v) {
  const double reflected = s.reflected.weight * (1 - s.reflected.escape);
  const double transmitted = s.transmitted.weight * (1 - s.transmitted.escape);
  const double kept = reflected + transmitted;
  weight_ *= kept;
  if (u * kept <= reflected) {
    collide(s.reflected.wi, depth_, v);
  } else {
    crossed_ = !crossed_;
    eta_ = 1 / eta_;
    collide(mirrored(s.transmitted.wi), depth_beyond(depth_), v);
  }
}

void MicroVertex::collide(Vec3 d, double depth, double u) {
  const double rate = collision_rate(ggx_, d);
  if (d.z > 0) {
    // Given that it does not escape: the exponential cut off at the surface's top.
    const double caught = -std::expm1(-rate * depth);
    depth_ = std::fmax(0.0, depth + std::log1p(-u * caught) / rate);
  } else {
    depth_ = depth - std::log(u) / rate;
  }
  w_ = -d;
}

DirectionalAlbedo directional_albedo(const RoughInterface& interface, double eta, double cos_o) {
  constexpr std::uint32_t n = 4096;
  const Vec3 wo{std::sqrt(std::fmax(0.0, 1 - cos_o * cos_o)), 0, cos_o};
  DirectionalAlbedo albedo;
  for (std::uint32_t i = 0; i < n; ++i) {
    PathSampler sampler(0x5eed, i);
    cross_microsurface(
        interface, eta, wo, sampler,
        [&](Vec3 wi, double weight) {
          (wi.z > 0 ? albedo.reflected : albedo.transmitted) += weight;
        },
        1e-4);  // a table's noise would stay in every picture made with it
  }
  return {albedo.reflected / n, albedo.transmitted / n};
}

}  // namespace translucube
