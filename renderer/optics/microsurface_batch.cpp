#include "renderer/optics/microsurface_batch.h"

#include "renderer/optics/microsurface.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/optics/microsurface_batch.cpp"
#include <hwy/foreach_target.h>
#include "renderer/optics/microfacet_simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// What is the same for all rays.
struct Microsurface {
  Facets facets;
  Real eta, inverse_eta;
  bool from_outside, multiple_scattering;

  explicit Microsurface(const BatchInterface& batch)
      : facets{batch.alpha},
        eta(batch.eta),
        inverse_eta(1 / batch.eta),
        from_outside(batch.from_outside),
        multiple_scattering(batch.multiple_scattering) {}
};

/// As many rays at a collision as a register holds.
struct Rays {
  const Microsurface& surface;
  Mask present;
  Bits slot;
  Random random;
  Basis frame;
  Vector w;
  Real side, depth, weight, connected;
  Side here;
  Mask outside;  ///< where light reaches the outside by reflection
  Real beyond;   ///< depth from the other side
  Real area;

  HWY_INLINE Rays(const Microsurface& of, const MicrosurfaceBatch::Walking& rays, std::size_t i)
      : surface(of),
        present(first(rays.size - i)),
        slot(load(rays.slot, i)),
        random(load(rays.random, i)),
        frame(load(rays.n, i)),
        w(load(rays.w, i)),
        side(load(rays.side, i)),
        depth(load(rays.depth, i)),
        weight(load(rays.weight, i)),
        connected(load(rays.connected, i)) {
    const Mask arrived = side > 0;  // on the side of arrival
    here = {select(arrived, surface.eta, surface.inverse_eta),
            select(arrived, surface.inverse_eta, surface.eta)};
    outside = surface.from_outside ? arrived : complement(arrived);
    beyond = depth_beyond(depth);
    area = surface.facets.projected_area(w);
  }

  /// Between world space and the frame of the side where the rays are.
  HWY_INLINE Vector to_world(Vector d) const { return frame.to_world({d.x, d.y, d.z * side}); }

  /// Looks for light from a few directions.
  HWY_INLINE void look_for_light(const LightList& lights, std::uint32_t lights_each,
                                 MicrosurfaceBatch::Lit& lit) {
    const Facets& facets = surface.facets;
    const Real light_depth = select(outside, depth, beyond);
    const Real bend = select(outside, 1, here.eta);
    const Mask sought_here = both(present, connected < 1);
    Bits light = random.bits();
    for (std::uint32_t k = 0; k < lights_each; ++k) {
      light = (light + Bits(LightList::size / lights_each)) & Bits(LightList::size - 1);
      const Vector wi_first = frame.to_local(load(lights.direction, light));
      const Vector wi{wi_first.x, wi_first.y, wi_first.z * side};
      const Vector m = facet_between(w, wi, bend);
      const Real w_m = dot(w, m), wi_m = dot(wi, m);
      const Side::Refraction crossing = here.refraction(w_m);
      const Real pdf = facets.density(m) * w_m / area *
                       select(outside, Real(0.25f) / w_m, here.refraction_jacobian(w_m, wi_m));
      const Real part = select(outside, crossing.reflectance, Real(1) - crossing.reflectance);
      const Real escape = facets.escape({wi.x, wi.y, abs(wi.z)}, light_depth);
      const Real sought = Real(static_cast<float>(lights_each)) * load(lights.pdf, light);
      const Real share = weight * part * escape * pdf / (sought + pdf);
      const Mask seen = surface.from_outside ? wi_first.z > 0 : wi_first.z < 0;
      const Mask possible = both(w_m > 0, either(outside, wi_m < 0));
      const Mask found = both(both(sought_here, seen), both(possible, share > 0));
      pack(slot, found, lit.slot, lit.size);
      pack(light, found, lit.light, lit.size);
      pack(share, found, lit.share, lit.size);
      lit.size += count(found);
    }
  }
};

/// The rays that a microfacet reflects (up) and refracts (down), each with the share of light that
/// goes there and meets no further microfacet.
struct Split {
  Real w_m, cos_t, density, reflectance;
  Vector up, down;
  Real up_share, down_share;

  HWY_INLINE Split(const Rays& rays, Real u, Real v) {
    const Facets& facets = rays.surface.facets;
    const Vector m = facets.sample_visible(rays.w, u, v);
    w_m = dot(rays.w, m);
    const Mask met = w_m > 0;  // else rounding at grazing incidence: passed as if reflected
    const Side::Refraction crossing = rays.here.refraction(w_m);
    cos_t = crossing.cos_t;
    reflectance = select(met, crossing.reflectance, 1);
    up = select(met, fma(Real(2) * w_m, m, -rays.w), rays.w);
    down = rays.here.refract(rays.w, m, w_m, cos_t);
    const Real up_escape = or_zero(met, facets.escape(up, rays.depth));
    const Real down_escape = or_zero(reflectance < 1, facets.escape(mirrored(down), rays.beyond));
    up_share = reflectance * up_escape;
    down_share = (Real(1) - reflectance) * down_escape;
    density = facets.density(m) * w_m / rays.area;
  }
};

/// What leaves to the outside.
HWY_INLINE void send_out(const Rays& rays, const Split& split, MicrosurfaceBatch::Sent& sent) {
  const Real weight = rays.weight * select(rays.outside, split.up_share, split.down_share);
  const Mask leaves = both(rays.present, weight > 0);
  const Real jacobian = select(rays.outside, Real(0.25f) / split.w_m,
                               rays.here.refraction_jacobian(split.w_m, -split.cos_t));
  const std::size_t to = sent.size;
  pack(rays.slot, leaves, sent.slot, to);
  pack(rays.to_world(select(rays.outside, split.up, split.down)), leaves, sent.direction, to);
  pack(weight, leaves, sent.weight, to);
  pack(split.density * jacobian, leaves, sent.pdf, to);
  pack(rays.connected, leaves, sent.connected, to);
  sent.size += count(leaves);
}

/// What goes into the body: one ray for all (a reservoir of one).
struct Reservoir {
  Vector direction;
  Real weight;

  HWY_INLINE void add(Rays& rays, const Split& split) {
    const Real in_weight = rays.weight * select(rays.outside, split.down_share, split.up_share);
    weight = weight + in_weight;
    const Mask chosen = rays.random.uniform() * weight < in_weight;
    direction =
        select(chosen, rays.to_world(select(rays.outside, split.down, split.up)), direction);
  }
};

/// On to the next microfacet.
struct Next {
  Mask stays;  ///< on the same side
  Vector d;
  Real depth, weight;
  Mask goes_on;

  HWY_INLINE Next(Rays& rays, const Split& split) {
    Random& random = rays.random;
    const Real up_kept = split.reflectance - split.up_share,
               down_kept = (Real(1) - split.reflectance) - split.down_share;
    const Real all_kept = up_kept + down_kept;
    stays = fma(random.uniform(), all_kept, -up_kept) < 0;
    d = select(stays, split.up, mirrored(split.down));
    const Real from = select(stays, rays.depth, rays.beyond),
               rate = rays.surface.facets.collision_rate(d);
    const Real u = random.uniform_positive();
    const Real caught = -expm1(-(rate * from));
    depth = select(d.z > 0, max(0, from + log1p(-(u * caught)) / rate), from - log(u) / rate);
    weight = rays.weight * all_kept;
    const Real threshold(static_cast<float>(roulette_of_microfacets));
    const Mask survives = either(weight >= threshold, random.uniform() * threshold < weight);
    weight = max(weight, threshold);
    goes_on = rays.surface.multiple_scattering ? both(rays.present, survives) : first(0);
  }
};

/// What goes on, to be rays at their next collision.
HWY_INLINE void keep(Rays& rays, const Next& next, const Reservoir& inward,
                     MicrosurfaceBatch::Walking& walking, std::size_t kept) {
  const Real u = rays.random.uniform(), v = rays.random.uniform();
  pack(rays.slot, next.goes_on, walking.slot, kept);
  pack(rays.random, next.goes_on, walking.random, kept);
  pack(rays.frame.z, next.goes_on, walking.n, kept);
  pack(-next.d, next.goes_on, walking.w, kept);
  pack(select(next.stays, rays.side, -rays.side), next.goes_on, walking.side, kept);
  pack(next.depth, next.goes_on, walking.depth, kept);
  pack(next.weight, next.goes_on, walking.weight, kept);
  pack(u, next.goes_on, walking.u, kept);
  pack(v, next.goes_on, walking.v, kept);
  pack(inward.direction, next.goes_on, walking.inward, kept);
  pack(inward.weight, next.goes_on, walking.inward_weight, kept);
  pack(Real(0), next.goes_on, walking.connected, kept);
}

void Collide(const BatchInterface& batch, const LightList& lights, std::uint32_t lights_each,
             MicrosurfaceBatch::Walking& walking, MicrosurfaceBatch::Sent& sent,
             MicrosurfaceBatch::Lit& lit, MicrosurfaceBatch::Inward& ended) {
  const Microsurface surface(batch);
  std::size_t kept = 0;
  sent.size = lit.size = 0;
  for (std::size_t i = 0; i < walking.size; i += at_once) {
    Rays rays(surface, walking, i);
    rays.look_for_light(lights, lights_each, lit);
    const Split split(rays, load(walking.u, i), load(walking.v, i));
    send_out(rays, split, sent);
    Reservoir inward{load(walking.inward, i), load(walking.inward_weight, i)};
    inward.add(rays, split);
    const Next next(rays, split);
    // What ended goes to the slot of its arrival, the rest where nobody reads.
    const Bits place = select(except(rays.present, next.goes_on), rays.slot,
                              static_cast<std::uint32_t>(MicrosurfaceBatch::capacity));
    store(inward.direction, ended.direction, place);
    store(inward.weight, ended.weight, place);
    keep(rays, next, inward, walking, kept);
    kept += count(next.goes_on);
  }
  walking.size = kept;
}

/// The depth of the first collision, from directions in world space.
void Start(const BatchInterface& interface, MicrosurfaceBatch::Walking& rays) {
  const Facets facets{interface.alpha};
  for (std::size_t i = 0; i < rays.size; i += at_once) {
    Vector w = Basis(load(rays.n, i)).to_local(load(rays.w, i));
    w.z = max(w.z, Real(1e-7f));  // it arrived, so rounding alone can say otherwise
    Random random = load(rays.random, i);
    store(-log(random.uniform_positive()) / facets.collision_rate(-w), rays.depth, i);
    store(w, rays.w, i);
    store(random.drawn, rays.random.drawn, i);
  }
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(Start);
HWY_EXPORT(Collide);

void MicrosurfaceBatch::push(Vec3 n, Vec3 d, Sample2 u, std::uint64_t key, bool connected) {
  const std::size_t i = walking_.size++;
  walking_.slot[i] = static_cast<std::uint32_t>(i);
  walking_.random.start(i, key);
  walking_.n.set(i, n);
  walking_.w.set(i, -d);
  walking_.side[i] = walking_.weight[i] = 1;
  walking_.u[i] = static_cast<float>(u.u);
  walking_.v[i] = static_cast<float>(u.v);
  walking_.inward_weight[i] = 0;
  walking_.connected[i] = connected ? 1.0f : 0.0f;
}

void MicrosurfaceBatch::start(const BatchInterface& interface) {
  HWY_DYNAMIC_DISPATCH(Start)(interface, walking_);
}

void MicrosurfaceBatch::collide(const BatchInterface& interface, const LightList& lights,
                                std::uint32_t lights_each) {
  HWY_DYNAMIC_DISPATCH(Collide)
  (interface, lights, lights.empty() ? 0 : lights_each, walking_, sent_, lit_, inward_);
}

}  // namespace translucube
#endif
