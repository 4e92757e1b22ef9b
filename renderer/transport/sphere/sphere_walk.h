#pragma once

// The random walk of walk.h in the unit sphere, for many paths at a time, in SIMD and single
// precision. Event by event: each path that is at a collision takes a large step or a new
// direction, then its next free flight. Where a body is dense all happens close to the boundary, so
// the depth is kept beside the position in a form that does not cancel: 1 - |p|^2.

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderer/base/vec.h"
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

  /// The chance at a depth 1 - |p|^2.
  double chance(double depth2) const { return std::exp(-falling * 0.5 * sigma_s * depth2); }
};

class SphereWalk {
 public:
  static constexpr std::size_t capacity = 1024;  ///< a multiple of every register's lanes
  /// So that equal places of two arrays do not fall into the same set of a cache.
  static constexpr std::size_t padding = 16;
  using Floats = std::array<float, capacity + padding>;
  using Integers = std::array<std::uint32_t, capacity + padding>;

  /// Walks under way (structure of arrays). `length` is counted from their push.
  struct Walking {
    std::size_t size = 0;
    Integers slot;
    Integers key_low, key_high, drawn;  ///< random numbers: a hash of the key and a count
    Floats p_x, p_y, p_z, depth2, d_x, d_y, d_z, length;
    Floats colliding;  ///< 1 at a collision, 0 where a flight comes next
  };
  /// Collisions that look for light, before their new direction is chosen.
  struct Vertices {
    std::size_t size = 0;
    Integers slot, bits;
    Floats p_x, p_y, p_z, depth2, d_x, d_y, d_z, length;
    Floats chance;   ///< with which they do
    Floats u, v, w;  ///< numbers uniform in [0, 1)
  };
  /// Walks that have come to the boundary.
  struct Arrivals {
    std::size_t size = 0;
    Integers slot;
    Floats n_x, n_y, n_z, d_x, d_y, d_z, length;
    // Of the last flight: where it began, its length, and the density of its direction per solid
    // angle if light was looked for from there with the direction still open; else 0.
    Floats from_x, from_y, from_z, from_depth2, flight, phase;
  };

  /// A walk from p (depth2 = 1 - |p|^2) along d; `colliding`: at a collision, d the direction in
  /// which it comes.
  void push(std::uint32_t slot, Vec3 p, double depth2, Vec3 d, bool colliding, std::uint64_t key);
  std::size_t under_way() const { return walking_.size; }
  /// The next collision and flight of all.
  void advance(const WalkMedium& medium);

  const Vertices& vertices() const { return vertices_; }
  const Arrivals& arrivals() const { return arrivals_; }

 private:
  Walking walking_;
  Vertices vertices_;
  Arrivals arrivals_;
};

}  // namespace translucube
