#include "renderer/transport/sphere/rough_exits_batch.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/transport/sphere/rough_exits_batch.cpp"
#include <hwy/foreach_target.h>
#include "renderer/optics/microfacet_simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// A point inside the unit sphere.
struct Vertex {
  Vector up;    ///< outward radius, unit
  Real depth2;  ///< 1 - rho^2
  Real rho = sqrt(Real(1) - depth2);

  /// To the surface along d.
  HWY_INLINE Real distance(Vector d) const {
    const Real b = rho * dot(up, d), root = sqrt(fma(b, b, depth2));
    return select(b > 0, depth2 / (b + root), root - b);
  }
  HWY_INLINE Vector at(Real t, Vector d) const { return normalize(fma(t, d, rho * up)); }
};

/// Beyond the facet m, as light from `light` goes there, backwards: the way from inside to it.
HWY_INLINE Vector way_to(Vector light, Vector m, Real light_m, const Side& above) {
  return -above.refract(light, m, light_m, above.refraction(light_m).cos_t);
}

/// The surface's normal about where the smooth one refracts towards the light: two steps of a fixed
/// point. Any will do that depends on nothing but the vertex and the light.
HWY_INLINE Vector place_towards(const Vertex& from, Vector light, const Side& above) {
  Vector n = from.up;
  for (int step = 0; step < 2; ++step) {
    const Vector d = normalize(way_to(light, n, max(dot(light, n), 0), above));
    n = from.at(from.distance(d), d);
  }
  return n;
}

constexpr float least_cosine = 1e-3f;  // of the light above the surface there

/// The density of the way from inside through the facet m to the light, in a frame whose normal
/// points outwards.
HWY_INLINE Real density_of(const Facets& facets, const Side& above, Vector light, Vector m,
                           Real light_m, Real cos_t) {
  return facets.density(m) * light_m / facets.projected_area(light) *
         above.refraction_jacobian(light_m, -cos_t);
}

void Connect(const RoughExitMedium& medium, RoughConnections& batch) {
  const Facets facets{medium.alpha};
  const Side above{medium.ior, 1 / medium.ior}, below{1 / medium.ior, medium.ior};
  const Real g(medium.g);
  for (std::size_t i = 0; i < batch.size; i += hn::Lanes(D())) {
    const Vertex from{{load(&batch.up_x[i]), load(&batch.up_y[i]), load(&batch.up_z[i])},
                      load(&batch.depth2[i])};
    const Vector light{load(&batch.light_x[i]), load(&batch.light_y[i]), load(&batch.light_z[i])};
    Random random{load(&batch.key_low[i]), load(&batch.key_high[i]), hn::Zero(DU())};

    // A way out.
    const Basis there(place_towards(from, light, above));
    const Vector towards = there.to_local(light);
    const Mask in_sight = towards.z > least_cosine;
    const Real u = random.uniform(), v = random.uniform();
    const Vector drawn = facets.sample_visible(towards, u, v);
    const Real towards_m = dot(towards, drawn);
    const Side::Refraction inwards = above.refraction(towards_m);
    const Vector d = there.to_world(-above.refract(towards, drawn, towards_m, inwards.cos_t));
    const Real chosen = density_of(facets, above, towards, drawn, towards_m, inwards.cos_t) *
                        load(&batch.light_pdf[i]);

    // Along it, and out by one collision.
    const Real distance = from.distance(d);
    const Basis inside(-from.at(distance, d));
    const Vector w = inside.to_local(-d), wi = inside.to_local(light);
    const Vector h = fma(below.eta, wi, w);
    const Vector m = hn::CopySign(Real(1).v, h.z.v) * normalize(h);
    const Real w_m = dot(w, m), wi_m = dot(wi, m);
    const Mask possible = both(both(w.z > 0, wi.z < 0), both(w_m > 0, wi_m < 0));
    const Real lobe =
        facets.density(m) * w_m / facets.projected_area(w) * below.refraction_jacobian(w_m, wi_m);
    const Real depth = -log(random.uniform_positive()) / facets.collision_rate(-w);
    const Real leaves = (Real(1) - below.refraction(w_m).reflectance) *
                        facets.escape(mirrored(wi), depth_beyond(depth));

    const Vector before{load(&batch.d_x[i]), load(&batch.d_y[i]), load(&batch.d_z[i])};
    const Real q = fma(g, g - Real(2) * dot(before, d), 1);
    const Real phase = Real(1 / (4 * pi_f)) * fnma(g, g, 1) / (q * sqrt(q));
    const Real walked = phase * exp(-(Real(medium.sigma_s) * distance)) * lobe;
    const Real share = walked * leaves / (chosen + walked);
    const Mask found = both(both(in_sight, towards_m > 0), both(possible, share > 0));
    hn::StoreU(or_zero(found, share).v, D(), &batch.share[i]);
    hn::StoreU(distance.v, D(), &batch.distance[i]);
  }
}

void Densities(const RoughExitMedium& medium, RoughWays& batch) {
  const Facets facets{medium.alpha};
  const Side above{medium.ior, 1 / medium.ior};
  for (std::size_t i = 0; i < batch.size; i += hn::Lanes(D())) {
    const Vertex from{{load(&batch.up_x[i]), load(&batch.up_y[i]), load(&batch.up_z[i])},
                      load(&batch.depth2[i])};
    const Vector light{load(&batch.light_x[i]), load(&batch.light_y[i]), load(&batch.light_z[i])};
    const Basis there(place_towards(from, light, above));
    const Vector towards = there.to_local(light);
    const Vector wi =
        there.to_local({-load(&batch.d_x[i]), -load(&batch.d_y[i]), -load(&batch.d_z[i])});
    const Vector h = fma(above.eta, wi, towards);
    const Vector m = hn::CopySign(Real(1).v, h.z.v) * normalize(h);
    const Real light_m = dot(towards, m), wi_m = dot(wi, m);
    const Mask possible = both(towards.z > least_cosine, both(light_m > 0, wi_m < 0));
    hn::StoreU(or_zero(possible, density_of(facets, above, towards, m, light_m, -wi_m)).v, D(),
               &batch.density[i]);
  }
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(Connect);
HWY_EXPORT(Densities);

void connect_rough(const RoughExitMedium& medium, RoughConnections& connections) {
  HWY_DYNAMIC_DISPATCH(Connect)(medium, connections);
}

void densities_of(const RoughExitMedium& medium, RoughWays& ways) {
  HWY_DYNAMIC_DISPATCH(Densities)(medium, ways);
}

}  // namespace translucube
#endif
