#include "renderer/transport/sphere/rough_exits_batch.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/transport/sphere/rough_exits_batch.cpp"
#include <hwy/foreach_target.h>
#include "renderer/optics/medium_simd.h"
#include "renderer/optics/microfacet_simd.h"
#include "renderer/transport/sphere/sphere_simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

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
    n = normalize(from.at(from.way_along(d), d));
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
  for (std::size_t i = 0; i < batch.size; i += at_once) {
    const Vertex from(batch, i);
    const Vector light = load(batch.light, i);
    Random random = load(batch.random, i);

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
                        load(batch.light_pdf, i);

    // Along it, and out by one collision.
    const Real distance = from.way_along(d);
    const Vector normal = normalize(from.at(distance, d));
    const Basis inside(-normal);
    const Vector w = inside.to_local(-d), wi = inside.to_local(light);
    const Vector m = facet_between(w, wi, below.eta);
    const Real w_m = dot(w, m), wi_m = dot(wi, m);
    const Mask possible = both(both(w.z > 0, wi.z < 0), both(w_m > 0, wi_m < 0));
    const Real lobe =
        facets.density(m) * w_m / facets.projected_area(w) * below.refraction_jacobian(w_m, wi_m);
    const Real depth = -log(random.uniform_positive()) / facets.collision_rate(-w);
    const Real leaves = (Real(1) - below.refraction(w_m).reflectance) *
                        facets.escape(mirrored(wi), depth_beyond(depth));

    const Real phase = henyey_greenstein(medium.g, dot(load(batch.d, i), d));
    const Real walked = phase * exp(-(Real(medium.sigma_s) * distance)) * lobe;
    const Real share = walked * leaves / (chosen + walked);
    const Mask found = both(both(in_sight, towards_m > 0), both(possible, share > 0));
    store(or_zero(found, share), batch.share, i);
    store(distance, batch.distance, i);
    store(normal, batch.normal, i);
  }
}

void Densities(const RoughExitMedium& medium, RoughWays& batch) {
  const Facets facets{medium.alpha};
  const Side above{medium.ior, 1 / medium.ior};
  for (std::size_t i = 0; i < batch.size; i += at_once) {
    const Vertex from(batch, i);
    const Vector light = load(batch.light, i);
    const Basis there(place_towards(from, light, above));
    const Vector towards = there.to_local(light);
    const Vector wi = there.to_local(-load(batch.d, i));
    const Vector m = facet_between(towards, wi, above.eta);
    const Real light_m = dot(towards, m), wi_m = dot(wi, m);
    const Mask possible = both(towards.z > least_cosine, both(light_m > 0, wi_m < 0));
    store(or_zero(possible, density_of(facets, above, towards, m, light_m, -wi_m)), batch.density,
          i);
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
