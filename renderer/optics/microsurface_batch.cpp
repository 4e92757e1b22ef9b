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

void Collide(const BatchInterface& interface, const LightList& lights, std::uint32_t lights_each,
             MicrosurfaceBatch::Walking& rays, MicrosurfaceBatch::Sent& sent,
             MicrosurfaceBatch::Lit& lit, float* const (&inward_out)[4]) {
  const Facets facets{interface.alpha};
  const float inverse = 1 / interface.eta;
  std::size_t kept = 0;
  sent.size = lit.size = 0;
  for (std::size_t i = 0; i < rays.size; i += hn::Lanes(D())) {
    const Mask present = hn::FirstN(D(), rays.size - i);
    const Bits slot = load(&rays.slot[i]);
    Random random{load(&rays.key_low[i]), load(&rays.key_high[i]), load(&rays.drawn[i])};
    const Vector n{load(&rays.n_x[i]), load(&rays.n_y[i]), load(&rays.n_z[i])};
    const Vector w{load(&rays.w_x[i]), load(&rays.w_y[i]), load(&rays.w_z[i])};
    const Real side = load(&rays.side[i]), depth = load(&rays.depth[i]);
    const Real weight = load(&rays.weight[i]);
    const Basis frame(n);
    const Mask arrived = side > 0;  // on the side of arrival
    const Side here{select(arrived, interface.eta, inverse),
                    select(arrived, inverse, interface.eta)};
    // Whether light reaches the outside by reflection.
    const Mask outside = interface.from_outside ? arrived : hn::Not(arrived);
    const Real beyond = depth_beyond(depth);
    const Real area = facets.projected_area(w);

    // Light from a few directions.
    const Real light_depth = select(outside, depth, beyond);
    const Real bend = select(outside, 1, here.eta);
    const Real connected = load(&rays.connected[i]);
    const Mask sought_here = both(present, connected < 1);
    Bits light = random.bits();
    for (std::uint32_t k = 0; k < lights_each; ++k) {
      light = hn::And(hn::Add(light, hn::Set(DU(), LightList::size / lights_each)),
                      hn::Set(DU(), LightList::size - 1));
      const Vector wi_first =
          frame.to_local({gather(lights.x.data(), light), gather(lights.y.data(), light),
                          gather(lights.z.data(), light)});
      const Vector wi{wi_first.x, wi_first.y, wi_first.z * side};
      const Vector h = fma(bend, wi, w);
      const Vector m = hn::CopySign(Real(1).v, h.z.v) * normalize(h);
      const Real w_m = dot(w, m), wi_m = dot(wi, m);
      const Side::Refraction crossing = here.refraction(w_m);
      const Real pdf = facets.density(m) * w_m / area *
                       select(outside, Real(0.25f) / w_m, here.refraction_jacobian(w_m, wi_m));
      const Real part = select(outside, crossing.reflectance, Real(1) - crossing.reflectance);
      const Real escape = facets.escape({wi.x, wi.y, abs(wi.z)}, light_depth);
      const Real sought = Real(static_cast<float>(lights_each)) * gather(lights.pdf.data(), light);
      const Real share = weight * part * escape * pdf / (sought + pdf);
      const Mask seen = interface.from_outside ? wi_first.z > 0 : wi_first.z < 0;
      const Mask possible = both(w_m > 0, hn::Or(outside, wi_m < 0));
      const Mask found = both(both(sought_here, seen), both(possible, share > 0));
      pack(slot, found, &lit.slot[lit.size]);
      pack(light, found, &lit.light[lit.size]);
      pack(share, found, &lit.share[lit.size]);
      lit.size += hn::CountTrue(D(), found);
    }

    // The microfacet, and the rays that it reflects and refracts.
    const Vector m = facets.sample_visible(w, load(&rays.u[i]), load(&rays.v[i]));
    const Real w_m = dot(w, m);
    const Mask met = w_m > 0;  // else rounding at grazing incidence: passed as if reflected
    const Side::Refraction crossing = here.refraction(w_m);
    const Real reflectance = select(met, crossing.reflectance, 1);
    const Vector up = select(met, fma(Real(2) * w_m, m, -w), w);
    const Vector down = here.refract(w, m, w_m, crossing.cos_t);
    const Real up_escape = or_zero(met, facets.escape(up, depth));
    const Real down_escape = or_zero(reflectance < 1, facets.escape(mirrored(down), beyond));
    const Real up_share = reflectance * up_escape;
    const Real down_share = (Real(1) - reflectance) * down_escape;
    const Real density = facets.density(m) * w_m / area;

    // What leaves to the outside.
    const auto to_world = [&](Vector d) { return frame.to_world({d.x, d.y, d.z * side}); };
    const Real out_weight = weight * select(outside, up_share, down_share);
    const Mask leaves = both(present, out_weight > 0);
    const Vector out = to_world(select(outside, up, down));
    pack(slot, leaves, &sent.slot[sent.size]);
    pack(out.x, leaves, &sent.x[sent.size]);
    pack(out.y, leaves, &sent.y[sent.size]);
    pack(out.z, leaves, &sent.z[sent.size]);
    pack(out_weight, leaves, &sent.weight[sent.size]);
    pack(density *
             select(outside, Real(0.25f) / w_m, here.refraction_jacobian(w_m, -crossing.cos_t)),
         leaves, &sent.pdf[sent.size]);
    pack(connected, leaves, &sent.connected[sent.size]);
    sent.size += hn::CountTrue(D(), leaves);

    // What goes into the body: one ray for all (a reservoir of one).
    const Real in_weight = weight * select(outside, down_share, up_share);
    const Real inward_weight = load(&rays.inward_weight[i]) + in_weight;
    const Mask chosen = random.uniform() * inward_weight < in_weight;
    const Vector inward =
        select(chosen, to_world(select(outside, down, up)),
               {load(&rays.inward_x[i]), load(&rays.inward_y[i]), load(&rays.inward_z[i])});

    // On to the next microfacet.
    const Real up_kept = reflectance - up_share, down_kept = (Real(1) - reflectance) - down_share;
    const Real all_kept = up_kept + down_kept;
    const Mask stays = fma(random.uniform(), all_kept, -up_kept) < 0;
    const Vector d = select(stays, up, mirrored(down));
    const Real from = select(stays, depth, beyond), rate = facets.collision_rate(d);
    const Real u = random.uniform_positive();
    const Real caught = -expm1(-(rate * from));
    const Real next_depth =
        select(d.z > 0, max(0, from + log1p(-(u * caught)) / rate), from - log(u) / rate);
    Real next_weight = weight * all_kept;
    const Real threshold(static_cast<float>(roulette_of_microfacets));
    const Mask survives =
        hn::Or(next_weight >= threshold, random.uniform() * threshold < next_weight);
    next_weight = max(next_weight, threshold);
    const Mask goes_on =
        interface.multiple_scattering ? both(present, survives) : hn::FirstN(D(), 0);

    // Ended: to the slot of its arrival; the others to the one that nobody reads.
    const Bits place =
        hn::IfThenElse(hn::RebindMask(DU(), both(present, hn::Not(goes_on))), slot,
                       hn::Set(DU(), static_cast<std::uint32_t>(MicrosurfaceBatch::capacity)));
    scatter(inward.x, inward_out[0], place);
    scatter(inward.y, inward_out[1], place);
    scatter(inward.z, inward_out[2], place);
    scatter(inward_weight, inward_out[3], place);

    const Real next_u = random.uniform(), next_v = random.uniform();
    pack(slot, goes_on, &rays.slot[kept]);
    pack(random.key_low, goes_on, &rays.key_low[kept]);
    pack(random.key_high, goes_on, &rays.key_high[kept]);
    pack(random.drawn, goes_on, &rays.drawn[kept]);
    pack(n.x, goes_on, &rays.n_x[kept]);
    pack(n.y, goes_on, &rays.n_y[kept]);
    pack(n.z, goes_on, &rays.n_z[kept]);
    pack(-d.x, goes_on, &rays.w_x[kept]);
    pack(-d.y, goes_on, &rays.w_y[kept]);
    pack(-d.z, goes_on, &rays.w_z[kept]);
    pack(select(stays, side, -side), goes_on, &rays.side[kept]);
    pack(next_depth, goes_on, &rays.depth[kept]);
    pack(next_weight, goes_on, &rays.weight[kept]);
    pack(next_u, goes_on, &rays.u[kept]);
    pack(next_v, goes_on, &rays.v[kept]);
    pack(inward.x, goes_on, &rays.inward_x[kept]);
    pack(inward.y, goes_on, &rays.inward_y[kept]);
    pack(inward.z, goes_on, &rays.inward_z[kept]);
    pack(inward_weight, goes_on, &rays.inward_weight[kept]);
    pack(Real(0), goes_on, &rays.connected[kept]);
    kept += hn::CountTrue(D(), goes_on);
  }
  rays.size = kept;
}

/// The depth of the first collision, from directions in world space.
void Start(const BatchInterface& interface, MicrosurfaceBatch::Walking& rays) {
  const Facets facets{interface.alpha};
  for (std::size_t i = 0; i < rays.size; i += hn::Lanes(D())) {
    const Basis frame({load(&rays.n_x[i]), load(&rays.n_y[i]), load(&rays.n_z[i])});
    Vector w = frame.to_local({load(&rays.w_x[i]), load(&rays.w_y[i]), load(&rays.w_z[i])});
    w.z = max(w.z, Real(1e-7f));  // it arrived, so rounding alone can say otherwise
    Random random{load(&rays.key_low[i]), load(&rays.key_high[i]), load(&rays.drawn[i])};
    const Real depth = -log(random.uniform_positive()) / facets.collision_rate(-w);
    hn::StoreU(w.x.v, D(), &rays.w_x[i]);
    hn::StoreU(w.y.v, D(), &rays.w_y[i]);
    hn::StoreU(w.z.v, D(), &rays.w_z[i]);
    hn::StoreU(depth.v, D(), &rays.depth[i]);
    hn::StoreU(random.drawn, DU(), &rays.drawn[i]);
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
  walking_.key_low[i] = static_cast<std::uint32_t>(key);
  walking_.key_high[i] = static_cast<std::uint32_t>(key >> 32);
  walking_.drawn[i] = 0;
  walking_.n_x[i] = static_cast<float>(n.x);
  walking_.n_y[i] = static_cast<float>(n.y);
  walking_.n_z[i] = static_cast<float>(n.z);
  walking_.w_x[i] = static_cast<float>(-d.x);
  walking_.w_y[i] = static_cast<float>(-d.y);
  walking_.w_z[i] = static_cast<float>(-d.z);
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
  float* const inward[4] = {inward_x_.data(), inward_y_.data(), inward_z_.data(),
                            inward_weight_.data()};
  HWY_DYNAMIC_DISPATCH(Collide)
  (interface, lights, lights.empty() ? 0 : lights_each, walking_, sent_, lit_, inward);
}

}  // namespace translucube
#endif
