#include "renderer/transport/sphere/sphere_walk.h"

#include "renderer/optics/ball_tables.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/transport/sphere/sphere_walk.cpp"
#include <hwy/foreach_target.h>
#include "renderer/optics/medium_simd.h"
#include "renderer/transport/sphere/sphere_simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// A ball of a level in ball_tables.h, by its optical radius.
struct Ball {
  Real radius, mu, length;

  /// The largest with at most this optical radius, at least 2; `exit` draws one of its exits.
  HWY_INLINE Ball(Real largest, Bits exit) {
    const Bits exponent = shift_right<23>(as_bits(largest));  // of 2: 128
    const auto level = [&](int most) {
      return min(exponent, Bits(static_cast<std::uint32_t>(128 + most)));
    };
    const auto radius_of = [](Bits biased) { return as_real(shift_left<23>(biased)); };
    const Bits table = level(tabulated_levels - 1);
    radius = radius_of(level(ball_levels - 1));
    const Bits row = max(table, Bits(128)) - Bits(128);
    const Bits index = row * Bits(exits_per_ball) + (exit & Bits(exits_per_ball - 1));
    const float* exits = &ball_exits()->mu;
    mu = gather(exits, index + index);
    // Beyond the tables lengths grow as mean_ball_length() does.
    const Real longer = (radius + Real(milne_length)) / (radius_of(table) + Real(milne_length));
    length = gather(exits + 1, index + index) * longer * longer;
  }
};

constexpr float least_depth2 = 1e-30f;

/// What is the same for all walks.
struct Scatterers {
  Real sigma_s, free_path, g, margin, falling;
  bool isotropic, connecting;

  explicit Scatterers(const WalkMedium& medium)
      : sigma_s(medium.sigma_s),
        free_path(1 / medium.sigma_s),
        g(medium.g),
        margin(medium.margin),
        falling(medium.falling),
        isotropic(medium.g == 0),
        connecting(medium.falling >= 0) {}
};

/// henyey_greenstein(), rounded in another order: the density weighs light in pictures that are
/// kept.
HWY_INLINE Real density_of_turn(Real g, Real cosine) {
  const Real q = fma(g, g, fnma(g + g, cosine, 1));
  return (Real(1) - g * g) * Real(quarter_inv_pi) / (q * sqrt(q));
}

/// As many walks as a register holds.
struct Walks {
  const Scatterers& scatterers;
  Mask present;
  Bits slot;
  Random random;
  Vector p, d;
  Real depth2, length;
  Mask colliding;
  Real phase = 0;  ///< Arrivals' for the flight to come

  HWY_INLINE Walks(const Scatterers& of, const SphereWalk::Walking& walking, std::size_t i)
      : scatterers(of),
        present(first(walking.size - i)),
        slot(load(walking.slot, i)),
        random(load(walking.random, i)),
        p(load(walking.p, i)),
        d(load(walking.d, i)),
        depth2(load(walking.depth2, i)),
        length(load(walking.length, i)),
        colliding(both(present, load(walking.colliding, i) > 0)) {}

  /// Collisions: deep inside an isotropic medium a large step, elsewhere a new direction, before
  /// which light is looked for.
  HWY_INLINE void collide(SphereWalk::Vertices& vertices) {
    const Real optical = Real(0.5f) * depth2 * scatterers.sigma_s;
    const Real room = optical - scatterers.margin;
    const Mask deep = scatterers.isotropic ? both(colliding, room >= 2) : first(0);
    const Mask turning = except(colliding, deep);
    if (scatterers.connecting) look_for_light(turning, optical, vertices);
    const Real u = random.uniform(), phi = Real(2 * pi_f) * random.uniform();
    phase = scatterers.connecting ? quarter_inv_pi : 0.0f;
    if (scatterers.isotropic)
      step_or_turn(deep, room, direction(fma(-2, u, 1), phi));
    else
      turn(sample_henyey_greenstein(scatterers.g, u), phi);
    phase = or_zero(turning, phase);
  }

  HWY_INLINE void look_for_light(Mask turning, Real optical, SphereWalk::Vertices& vertices) {
    const Real chance = exp(-(scatterers.falling * optical));
    const Mask looks = both(turning, random.uniform() < chance);
    const std::size_t to = vertices.size;
    pack(slot, looks, vertices.slot, to);
    pack(random.bits(), looks, vertices.bits, to);
    pack(p, looks, vertices.p, to);
    pack(d, looks, vertices.d, to);
    pack(depth2, looks, vertices.depth2, to);
    pack(length, looks, vertices.length, to);
    pack(chance, looks, vertices.chance, to);
    pack(random.uniform(), looks, vertices.u, to);
    pack(random.uniform(), looks, vertices.v, to);
    pack(random.uniform(), looks, vertices.w, to);
    vertices.size += count(looks);
  }

  /// `drawn`: a direction, equal in all. Where a walk is deep there is room for a ball, with this
  /// optical radius less than the one to the boundary.
  HWY_INLINE void step_or_turn(Mask deep, Real room, Vector drawn) {
    const Bits exit = random.bits();
    const Real phi = Real(2 * pi_f) * random.uniform();
    Vector turned = drawn;
    if (!none(deep)) {
      const Ball ball(max(room, 2), exit);
      const Real radius = ball.radius * scatterers.free_path;
      const Real risen = radius * fma(2, dot(p, drawn), radius);
      turned = select(deep, Basis(drawn).to_world(direction(ball.mu, phi)), drawn);
      p = select(deep, fma(radius, drawn, p), p);
      depth2 = select(deep, max(depth2 - risen, least_depth2), depth2);
      length = select(deep, fma(ball.length, scatterers.free_path, length), length);
    }
    d = select(colliding, turned, d);
  }

  HWY_INLINE void turn(Real cosine, Real phi) {
    const Vector turned = normalize(Basis(d).to_world(direction(cosine, phi)));
    if (scatterers.connecting) phase = density_of_turn(scatterers.g, cosine);
    d = select(colliding, turned, d);
  }

  /// The flight: those that come to the boundary arrive, the others go on at `kept`, whose number
  /// is told.
  HWY_INLINE std::size_t fly(SphereWalk::Arrivals& arrivals, SphereWalk::Walking& walking,
                             std::size_t kept) {
    const Real flight = -log(random.uniform_positive()) * scatterers.free_path;
    const Real b = dot(p, d), way = way_to_surface(b, depth2);
    const Mask arrives = both(present, flight >= way), stays = except(present, arrives);
    const std::size_t to = arrivals.size;
    pack(slot, arrives, arrivals.slot, to);
    pack(normalize(fma(way, d, p)), arrives, arrivals.n, to);
    pack(d, arrives, arrivals.d, to);
    pack(length + way, arrives, arrivals.length, to);
    pack(p, arrives, arrivals.from, to);
    pack(depth2, arrives, arrivals.from_depth2, to);
    pack(way, arrives, arrivals.flight, to);
    pack(phase, arrives, arrivals.phase, to);
    arrivals.size += count(arrives);

    pack(slot, stays, walking.slot, kept);
    pack(random, stays, walking.random, kept);
    pack(fma(flight, d, p), stays, walking.p, kept);
    pack(d, stays, walking.d, kept);
    pack(max(depth2 - flight * fma(2, b, flight), least_depth2), stays, walking.depth2, kept);
    pack(length + flight, stays, walking.length, kept);
    pack(Real(1), stays, walking.colliding, kept);
    return count(stays);
  }
};

void Advance(const WalkMedium& medium, SphereWalk::Walking& walking, SphereWalk::Vertices& vertices,
             SphereWalk::Arrivals& arrivals) {
  const Scatterers scatterers(medium);
  std::size_t kept = 0;
  vertices.size = arrivals.size = 0;
  for (std::size_t i = 0; i < walking.size; i += at_once) {
    Walks walks(scatterers, walking, i);
    walks.collide(vertices);
    kept += walks.fly(arrivals, walking, kept);
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
  walking_.random.start(i, key);
  walking_.p.set(i, p);
  walking_.depth2[i] = static_cast<float>(depth2);
  walking_.d.set(i, d);
  walking_.length[i] = 0;
  walking_.colliding[i] = colliding ? 1.0f : 0.0f;
}

void SphereWalk::advance(const WalkMedium& medium) {
  HWY_DYNAMIC_DISPATCH(Advance)(medium, walking_, vertices_, arrivals_);
}

}  // namespace translucube
#endif
