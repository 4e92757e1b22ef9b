#pragma once

// Multiple scattering between the microfacets of a Smith GGX surface (Heitz, Hanika, d'Eon,
// Dachsbacher 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model"), dielectric, both
// sides.
//
// To a ray the surface is a layer of scatterers: with the depth tau = -ln C1(h) in place of the
// height h, a ray that leaves along d collides at the constant rate Lambda(d) = sigma(-d) / |d.z|
// per depth and is out of the surface where tau falls below 0; seen from the other side of the
// interface a point at depth tau lies at tau' = -ln(1 - exp(-tau)). At each collision the ray meets
// a visible normal and both the reflected and the refracted ray are followed as far as they escape
// (splitting), so that energy is kept exactly; one of the rays that do not escape goes on to the
// next collision.
//
// Directions are local: z is the macroscopic normal on the side that the walk began on.

#include <cmath>

#include "renderer/base/sampler.h"
#include "renderer/optics/interface.h"
#include "renderer/optics/microfacet.h"

namespace translucube {

/// Collisions per depth of a ray along d.
inline double collision_rate(const Ggx& ggx, Vec3 d) {
  return ggx.projected_area(-d) / std::fmax(std::fabs(d.z), 1e-12);
}

/// The depth of the same point seen from the other side.
inline double depth_beyond(double depth) {
  return depth < 0.7 ? -std::log(-std::expm1(-std::fmax(depth, 1e-300)))
                     : -std::log1p(-std::exp(-depth));
}

/// The chance of a ray along d from this depth to meet no further microfacet.
inline double escape_from(const Ggx& ggx, Vec3 d, double depth) {
  return d.z > 0 ? std::exp(-collision_rate(ggx, d) * depth) : 0;
}

/// The normal, on w's side, of the facet by which light goes from wi to w; `eta`: index on wi's
/// side over index on w's.
inline Vec3 facet_between(Vec3 w, Vec3 wi, double eta) {
  const Vec3 h = w + eta * wi;
  return std::copysign(1, h.z) * normalize(h);
}

/// |d m / d wi| of refraction, wi_m < 0 (Walter et al. 2007, eq. 17); kept off infinity where the
/// indices are the same and nothing is refracted.
inline double refraction_jacobian(double eta, double w_m, double wi_m) {
  const double q = w_m + eta * wi_m;
  return eta * eta * -wi_m / std::fmax(q * q, 1e-20);
}

/// One ray after a collision, before it is known whether it escapes.
struct MicroBranch {
  Vec3 wi;            ///< away from the surface, in the frame of the vertex's side
  double weight = 0;  ///< Fresnel share
  double escape = 0;  ///< probability of meeting no further microfacet
};
struct MicroSample {
  MicroBranch reflected, transmitted;
};

/// A collision with a microfacet.
class MicroVertex {
 public:
  /// The first collision of a ray from `wo` (wo.z > 0), at a depth drawn with u in (0, 1].
  MicroVertex(const Ggx& ggx, double eta, Vec3 wo, double u);

  /// Share of the path's light that arrives at this collision.
  double weight() const { return weight_; }
  void set_weight(double weight) { weight_ = weight; }
  /// A direction of this side, in the frame of the side that the walk began on.
  Vec3 to_first_side(Vec3 w) const { return crossed_ ? Vec3{w.x, w.y, -w.z} : w; }

  MicroSample sample(Sample2 u) const;
  /// Moves on to the next collision of one of the two rays, chosen by what did not escape; weight()
  /// falls by that share. `u`, `v` in (0, 1].
  void advance(const MicroSample& sample, double u, double v);

 private:
  void collide(Vec3 d, double depth, double u);

  Ggx ggx_;
  double eta_;    ///< index beyond over index on the current side
  Vec3 w_;        ///< back along the arriving ray, in the current side's frame
  double depth_;  ///< from the current side
  double weight_ = 1;
  bool crossed_ = false;
};

/// Below this share of the light that arrived, chance decides whether it goes on to another
/// microfacet (chosen by relMSE x CPU).
inline constexpr double roulette_of_microfacets = 1.0 / 2;

/// Crosses the interface from `wo`, collision by collision: `escape(wi, weight)` receives every ray
/// that leaves the surface on either side, wi in the frame of the first side. The expected sum of
/// all weights is 1.
template <class Escape>
void cross_microsurface(const RoughInterface& interface, double eta, Vec3 wo, PathSampler& sampler,
                        Escape&& escape, double roulette = roulette_of_microfacets) {
  Rng& rng = sampler.rng();
  MicroVertex vertex(interface.microfacets, eta, wo, rng.uniform_positive());
  while (true) {
    const MicroSample sample = vertex.sample(sampler.next2());
    for (const MicroBranch* branch : {&sample.reflected, &sample.transmitted}) {
      const double weight = vertex.weight() * branch->weight * branch->escape;
      if (weight > 0) escape(vertex.to_first_side(branch->wi), weight);
    }
    if (!interface.multiple_scattering) return;
    vertex.advance(sample, rng.uniform_positive(), rng.uniform_positive());
    if (vertex.weight() >= roulette) continue;
    if (rng.uniform() * roulette >= vertex.weight()) return;
    vertex.set_weight(roulette);
  }
}

/// Share of the light from cos_o that the surface reflects and transmits; they sum to 1.
struct DirectionalAlbedo {
  double reflected = 0, transmitted = 0;
};
DirectionalAlbedo directional_albedo(const RoughInterface& interface, double eta, double cos_o);

}  // namespace translucube
