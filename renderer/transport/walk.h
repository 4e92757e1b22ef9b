#pragma once

// The random walk in a homogeneous body, collision by collision.

#include "renderer/optics/ball_tables.h"
#include "renderer/optics/medium.h"
#include "renderer/shape/half_space.h"
#include "renderer/shape/shape.h"
#include "renderer/transport/clearing.h"

namespace translucube {

/// What moves inside a body, in the body's unit of length.
struct Particle {
  Vec3 p, d;          ///< position, direction of travel
  double length = 0;  ///< inside the body so far
};

/// One free flight. True at the next collision; false where the boundary comes first: then `hit` is
/// on it and the particle still at its start.
template <class Shape>
bool fly(Shape&& shape, const Medium& medium, Particle& particle, Rng& rng, Hit& hit) {
  const double flight = medium.sample_flight(rng);
  if (shape.intersect_inside(particle.p, particle.d, flight, hit)) return false;
  particle.p = particle.p + flight * particle.d;
  particle.length += flight;
  return true;
}

/// After a collision deep inside an isotropic medium: one large step to the surface of the largest
/// ball that fits into the body. False where none does.
template <class Shape>
bool large_step(Shape&& shape, const Medium& medium, Particle& particle, Rng& rng,
                double margin = 0) {
  if (medium.g != 0) return false;
  const int level = ball_level(shape.clearance(particle.p) * medium.sigma_s - margin);
  if (level < 0) return false;
  const BallCrossing crossing = cross_ball(level, rng);
  particle.p = particle.p + (ball_radius(level) / medium.sigma_s) * crossing.outward;
  particle.d = crossing.direction;
  particle.length += crossing.length / medium.sigma_s;
  return true;
}

/// Whether a particle is outside by more than rounding: one that slipped out of a mesh by rounding
/// would walk for ever.
template <class Shape>
bool strayed(const Shape&, const Particle&) {
  return false;
}
inline bool strayed(const Mesh&, const Particle& particle) {
  return length_squared(particle.p) > 1.01;
}

/// A collision: a new direction, after a large step where there is room for one.
template <class Shape>
void scatter(Shape&& shape, const Medium& medium, Particle& particle, Rng& rng) {
  if (!large_step(shape, medium, particle, rng)) particle.d = medium.scatter(particle.d, rng);
}

}  // namespace translucube
