#pragma once

// The walk between the microfacets of microsurface.h, for many rays at a time, in SIMD and single
// precision. Collision by collision: each looks for light from a few directions of a list and sends
// out a ray; of the rays that go into the body one is kept for each ray that arrived.

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderer/light/light_list.h"
#include "renderer/optics/interface.h"

namespace translucube {

/// What is the same for all rays of a batch.
struct BatchInterface {
  float alpha = 0.1f;
  float eta = 1.5f;  ///< index beyond over index on the side of arrival
  bool from_outside = true;
  bool multiple_scattering = true;
};

class MicrosurfaceBatch {
 public:
  static constexpr std::size_t capacity = 256;  ///< a multiple of every register's lanes
  /// So that equal places of two arrays do not fall into the same set of a cache.
  static constexpr std::size_t padding = 16;
  /// Lights that a collision looks for.
  static constexpr std::size_t most_lights = 16;
  using Floats = std::array<float, capacity + padding>;
  using Integers = std::array<std::uint32_t, capacity + padding>;

  /// Rays on their way from microfacet to microfacet (structure of arrays).
  struct Walking {
    std::size_t size = 0;
    Integers slot;                      ///< of the arrival
    Integers key_low, key_high, drawn;  ///< random numbers: a hash of the key and a count
    Floats n_x, n_y, n_z;               ///< macroscopic normal on the side of arrival
    Floats w_x, w_y, w_z;  ///< back along the ray, local, on the side where it is (side 1: arrival)
    Floats side;           ///< 1 on the side of arrival, -1 beyond
    Floats depth, weight;
    Floats u, v;       ///< the numbers of the next microfacet's normal
    Floats connected;  ///< 1 where the light of this collision was looked for before, else 0
    Floats inward_x, inward_y, inward_z, inward_weight;  ///< the reservoir, world
  };
  /// Rays that left to the outside.
  struct Sent {
    std::size_t size = 0;
    Integers slot;
    Floats x, y, z, weight, pdf;
    Floats connected;  ///< of the collision
  };
  /// Light that was found.
  struct Lit {
    std::size_t size = 0;
    std::array<std::uint32_t, capacity * most_lights> slot, light;
    std::array<float, capacity * most_lights> share;  ///< of its radiance
  };

  /// A ray along `d` that meets an interface with normal `n` on its side; `u` draws the first
  /// normal. Its slot is the number of those pushed before. `connected`: the light of the first
  /// collision was looked for before.
  void push(Vec3 n, Vec3 d, Sample2 u, std::uint64_t key, bool connected = false);

  /// Begins the walks of all rays pushed.
  void start(const BatchInterface& interface);
  std::size_t under_way() const { return walking_.size; }
  /// The next collision of every ray under way. `lights_each` of the list, a power of two, are
  /// looked for at each.
  void collide(const BatchInterface& interface, const LightList& lights, std::uint32_t lights_each);

  const Sent& sent() const { return sent_; }
  const Lit& lit() const { return lit_; }
  /// When all have ended: the ray that goes into the body, for all that does.
  double inward_weight(std::size_t slot) const { return inward_weight_[slot]; }
  Vec3 inward(std::size_t slot) const {
    return {inward_x_[slot], inward_y_[slot], inward_z_[slot]};
  }

 private:
  Walking walking_;
  Sent sent_;
  Lit lit_;
  // One more than slots: what is written there is not meant.
  std::array<float, capacity + 1> inward_x_, inward_y_, inward_z_, inward_weight_;
};

}  // namespace translucube
