#include "renderer/transport/sphere/sphere_walk.h"

#include "renderer/optics/ball_tables.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/transport/sphere/sphere_walk.cpp"
#include <hwy/foreach_target.h>
#include "renderer/base/simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

constexpr float two_pi = 6.28318531f, quarter_inv_pi = 0.0795774715f;

HWY_INLINE Vector load(const SphereWalk::Floats& x, const SphereWalk::Floats& y,
                       const SphereWalk::Floats& z, std::size_t i) {
  return {load(&x[i]), load(&y[i]), load(&z[i])};
}
HWY_INLINE void pack(Vector value, Mask chosen, SphereWalk::Floats& x, SphereWalk::Floats& y,
                     SphereWalk::Floats& z, std::size_t i) {
  pack(value.x, chosen, &x[i]);
  pack(value.y, chosen, &y[i]);
  pack(value.z, chosen, &z[i]);
}

HWY_INLINE Vector direction(Real cosine, Real phi) {
  const Real sine = sqrt(max(fnma(cosine, cosine, 1), 0));
  return {sine * cos(phi), sine * sin(phi), cosine};
}

/// A ball of a level in ball_tables.h, by its optical radius.
struct Ball {
  Real radius, mu, length;

  /// The largest with at most this optical radius, at least 2; `exit` draws one of its exits.
  HWY_INLINE Ball(Real largest, Bits exit) {
    const Bits exponent = hn::ShiftRight<23>(hn::BitCast(DU(), largest.v));  // of 2: 128
    const auto level = [&](int most) {
      return hn::Min(exponent, hn::Set(DU(), static_cast<std::uint32_t>(128 + most)));
    };
    const auto radius_of = [](Bits biased) {
      return Real(hn::BitCast(D(), hn::ShiftLeft<23>(biased)));
    };
    const Bits table = level(tabulated_levels - 1);
    radius = radius_of(level(ball_levels - 1));
    const Bits row = hn::Sub(hn::Max(table, hn::Set(DU(), 128u)), hn::Set(DU(), 128u));
    const Bits index = hn::Add(hn::Mul(row, hn::Set(DU(), std::uint32_t(exits_per_ball))),
                               hn::And(exit, hn::Set(DU(), std::uint32_t(exits_per_ball - 1))));
    const float* exits = &ball_exits()->mu;
    mu = gather(exits, hn::Add(index, index));
    // Of balls beyond the tables: as mean_ball_length() grows.
    const Real longer = (radius + Real(milne_length)) / (radius_of(table) + Real(milne_length));
    length = gather(exits + 1, hn::Add(index, index)) * longer * longer;
  }
};

/// Of Henyey and Greenstein's phase function.
struct Phase {
  Real g, rest;  ///< 1 - g^2

  HWY_INLINE explicit Phase(float mean) : g(mean), rest(1 - mean * mean) {}
  HWY_INLINE Real sample(Real u) const {
    const Real q = rest / fma(g + g, u, Real(1) - g);
    return max(-1, min(1, (fma(g, g, 1) - q * q) / (g + g)));
  }
  HWY_INLINE Real density(Real cosine) const {
    const Real q = fma(g, g, fnma(g + g, cosine, 1));
    return rest * Real(quarter_inv_pi) / (q * sqrt(q));
  }
};

void Advance(const WalkMedium& medium, SphereWalk::Walking& walking, SphereWalk::Vertices& vertices,
             SphereWalk::Arrivals& arrivals) {
  const Real sigma_s(medium.sigma_s), free_path(1 / medium.sigma_s), least(1e-30f);
  const bool isotropic = medium.g == 0, connecting = medium.falling >= 0;
  const Phase phase_function(isotropic ? 0.5f : medium.g);
  std::size_t kept = 0;
  vertices.size = arrivals.size = 0;
  for (std::size_t i = 0; i < walking.size; i += hn::Lanes(D())) {
    const Mask present = hn::FirstN(D(), walking.size - i);
    const Bits slot = load(&walking.slot[i]);
    Random random{load(&walking.key_low[i]), load(&walking.key_high[i]), load(&walking.drawn[i])};
    Vector p = load(walking.p_x, walking.p_y, walking.p_z, i);
    Vector d = load(walking.d_x, walking.d_y, walking.d_z, i);
    Real depth2 = load(&walking.depth2[i]), length = load(&walking.length[i]);
    const Mask colliding = both(present, load(&walking.colliding[i]) > 0);

    // A collision: deep inside an isotropic medium a large step, elsewhere a new direction.
    const Real optical = Real(0.5f) * depth2 * sigma_s, room = optical - Real(medium.margin);
    const Mask deep = isotropic ? both(colliding, room >= 2) : hn::FirstN(D(), 0);
    const Mask turning = hn::AndNot(deep, colliding);
    if (connecting) {
      const Real chance = exp(-(Real(medium.falling) * optical));
      const Mask looks = both(turning, random.uniform() < chance);
      const std::size_t to = vertices.size;
      pack(slot, looks, &vertices.slot[to]);
      pack(random.bits(), looks, &vertices.bits[to]);
      pack(p, looks, vertices.p_x, vertices.p_y, vertices.p_z, to);
      pack(d, looks, vertices.d_x, vertices.d_y, vertices.d_z, to);
      pack(depth2, looks, &vertices.depth2[to]);
      pack(length, looks, &vertices.length[to]);
      pack(chance, looks, &vertices.chance[to]);
      pack(random.uniform(), looks, &vertices.u[to]);
      pack(random.uniform(), looks, &vertices.v[to]);
      pack(random.uniform(), looks, &vertices.w[to]);
      vertices.size += hn::CountTrue(D(), looks);
    }
    const Real u = random.uniform(), phi = Real(two_pi) * random.uniform();
    Real phase(connecting ? quarter_inv_pi : 0.0f);
    Vector turned;
    if (isotropic) {
      turned = direction(fma(-2, u, 1), phi);
      const Bits exit = random.bits();
      const Real exit_phi = Real(two_pi) * random.uniform();
      if (!hn::AllFalse(D(), deep)) {
        const Ball ball(max(room, 2), exit);
        const Vector outward = turned;
        const Real radius = ball.radius * free_path;
        const Real risen = radius * fma(2, dot(p, outward), radius);
        turned = select(deep, Basis(outward).to_world(direction(ball.mu, exit_phi)), turned);
        p = select(deep, fma(radius, outward, p), p);
        depth2 = select(deep, max(depth2 - risen, least), depth2);
        length = select(deep, fma(ball.length, free_path, length), length);
      }
    } else {
      const Real cosine = phase_function.sample(u);
      turned = normalize(Basis(d).to_world(direction(cosine, phi)));
      if (connecting) phase = phase_function.density(cosine);
    }
    d = select(colliding, turned, d);
    phase = or_zero(turning, phase);

    // The flight, and the way to the boundary, without cancellation on either side.
    const Real flight = -log(random.uniform_positive()) * free_path;
    const Real b = dot(p, d), root = sqrt(fma(b, b, depth2));
    const Real way = select(b > 0, depth2 / (b + root), root - b);
    const Mask arrives = both(present, flight >= way), stays = hn::AndNot(arrives, present);
    const std::size_t to = arrivals.size;
    pack(slot, arrives, &arrivals.slot[to]);
    pack(normalize(fma(way, d, p)), arrives, arrivals.n_x, arrivals.n_y, arrivals.n_z, to);
    pack(d, arrives, arrivals.d_x, arrivals.d_y, arrivals.d_z, to);
    pack(length + way, arrives, &arrivals.length[to]);
    pack(p, arrives, arrivals.from_x, arrivals.from_y, arrivals.from_z, to);
    pack(depth2, arrives, &arrivals.from_depth2[to]);
    pack(way, arrives, &arrivals.flight[to]);
    pack(phase, arrives, &arrivals.phase[to]);
    arrivals.size += hn::CountTrue(D(), arrives);

    pack(slot, stays, &walking.slot[kept]);
    pack(random.key_low, stays, &walking.key_low[kept]);
    pack(random.key_high, stays, &walking.key_high[kept]);
    pack(random.drawn, stays, &walking.drawn[kept]);
    pack(fma(flight, d, p), stays, walking.p_x, walking.p_y, walking.p_z, kept);
    pack(d, stays, walking.d_x, walking.d_y, walking.d_z, kept);
    pack(max(depth2 - flight * fma(2, b, flight), least), stays, &walking.depth2[kept]);
    pack(length + flight, stays, &walking.length[kept]);
    pack(Real(1), stays, &walking.colliding[kept]);
    kept += hn::CountTrue(D(), stays);
  }
  walking.size = kept;
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(Advance);

void SphereWalk::push(std::uint32_t slot, Vec3 p, double depth2, Vec3 d, bool colliding,
                      std::uint64_t key) {
  const std::size_t i = walking_.size++;
  walking_.slot[i] = slot;
  walking_.key_low[i] = static_cast<std::uint32_t>(key);
  walking_.key_high[i] = static_cast<std::uint32_t>(key >> 32);
  walking_.drawn[i] = 0;
  walking_.p_x[i] = static_cast<float>(p.x);
  walking_.p_y[i] = static_cast<float>(p.y);
  walking_.p_z[i] = static_cast<float>(p.z);
  walking_.depth2[i] = static_cast<float>(depth2);
  walking_.d_x[i] = static_cast<float>(d.x);
  walking_.d_y[i] = static_cast<float>(d.y);
  walking_.d_z[i] = static_cast<float>(d.z);
  walking_.length[i] = 0;
  walking_.colliding[i] = colliding ? 1.0f : 0.0f;
}

void SphereWalk::advance(const WalkMedium& medium) {
  HWY_DYNAMIC_DISPATCH(Advance)(medium, walking_, vertices_, arrivals_);
}

}  // namespace translucube
#endif
