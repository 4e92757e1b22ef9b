#pragma once

// This room has what only a sphere is simple enough for: walks of many paths together, and light
// that is looked for from their vertices through a smooth or a rough boundary. Nothing here knows
// of a path's stages (../tracer.h) or of another shape.
//
// The random walk of walk.h in the unit sphere, for many paths at a time, in SIMD and single
// precision. Event by event: each path that is at a collision takes a large step or a new
// direction, then its next free flight. Where a body is dense all happens close to the boundary, so
// the depth is kept beside the position in a form that does not cancel: 1 - |p|^2.

#include <cmath>

#include "renderer/base/batch.h"
#include "renderer/optics/medium.h"

namespace translucube {

/// What is the same for all walks of a body.
struct WalkMedium {
  float sigma_s = 1;  ///< [1 / radius], finite
  float g = 0;
  /// Mean free paths below the boundary where collisions are visited one by one.
  float margin = 0;
  /// Collisions look for light with the chance exp(-falling x optical depth); below 0: never.
  float falling = -1;

  WalkMedium(float density, float mean_cosine, float visited = 0, float fall = -1)
      : sigma_s(density), g(mean_cosine), margin(visited), falling(fall) {}
  /// `looking`: whether collisions look for light, with this margin and fall of the chance.
  WalkMedium(const Medium& medium, bool looking, float visited, float fall)
      : WalkMedium(static_cast<float>(medium.sigma_s), static_cast<float>(medium.g)) {
    if (looking) margin = visited, falling = fall;
  }

  /// The chance to look for light from the depth 1 - |p|^2.
  double chance(double depth2) const { return std::exp(-falling * 0.5 * sigma_s * depth2); }
};

class SphereWalk {
 public:
  static constexpr std::size_t capacity = 1024;

  /// Walks under way. `length` is counted from their push.
  struct Walking : Batch<capacity> {
    Integers slot;
    Streams random;
    Vectors p, d;
    Floats depth2, length;
    Floats colliding;  ///< 1 at a collision, 0 where a flight comes next
  };
  /// Collisions that look for light, before their new direction is chosen.
  struct Vertices : Batch<capacity> {
    Integers slot, bits;
    Vectors p, d;
    Floats depth2, length;
    Floats chance;   ///< with which they do
    Floats u, v, w;  ///< numbers uniform in [0, 1)
  };
  /// Walks that have come to the boundary.
  struct Arrivals : Batch<capacity> {
    Integers slot;
    Vectors n, d;
    Floats length;
    // The last flight: where it began, its length, and the density of its direction per solid
    // angle if light was looked for from there with the direction still open; else 0.
    Vectors from;
    Floats from_depth2, flight, phase;
  };

  /// A walk from p (depth2 = 1 - |p|^2) along d; `colliding`: at a collision, d the direction in
  /// which it comes.
  void push(std::uint32_t slot, Vec3 p, double depth2, Vec3 d, bool colliding, std::uint64_t key);
  std::size_t under_way() const { return walking_.size; }
  /// The next collision and flight of all.
  void advance(const WalkMedium& medium);

  /// Forgets the walks under way, whose slots `tell` is told.
  template <class Tell>
  void abandon(Tell&& tell) {
    for (std::size_t i = 0; i < walking_.size; ++i)
      tell(static_cast<std::uint32_t>(walking_.slot[i]));
    walking_.size = 0;
  }

  const Vertices& vertices() const { return vertices_; }
  const Arrivals& arrivals() const { return arrivals_; }

 private:
  Walking walking_;
  Vertices vertices_;
  Arrivals arrivals_;
};

}  // namespace translucube
