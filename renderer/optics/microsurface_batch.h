#pragma once

// The walk between the microfacets of microsurface.h, for many rays at a time, in SIMD and single
// precision. Collision by collision: each looks for light from a few directions of a list and sends
// out a ray; of the rays that go into the body one is kept for each ray that arrived.

#include "renderer/base/batch.h"
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
  static constexpr std::size_t capacity = 256;
  /// Lights that a collision looks for.
  static constexpr std::size_t most_lights = 16;

  /// Rays on their way from microfacet to microfacet.
  struct Walking : Batch<capacity> {
    Integers slot;  ///< the arrival's
    Streams random;
    Vectors n;    ///< macroscopic normal on the side of arrival
    Vectors w;    ///< back along the ray, local, on the side where it is (side 1: arrival)
    Floats side;  ///< 1 on the side of arrival, -1 beyond
    Floats depth, weight;
    Floats u, v;       ///< the numbers of the next microfacet's normal
    Floats connected;  ///< 1 where the light of this collision was looked for before, else 0
    Vectors inward;    ///< with inward_weight: the reservoir, world
    Floats inward_weight;
  };
  /// Rays that left to the outside.
  struct Sent : Batch<capacity> {
    Integers slot;
    Vectors direction;
    Floats weight, pdf;
    Floats connected;  ///< as in Walking, at the collision
  };
  /// Light that was found.
  struct Lit {
    std::size_t size = 0;
    std::array<std::uint32_t, capacity * most_lights> slot, light;
    std::array<float, capacity * most_lights> share;  ///< of the light's radiance
  };
  /// The ray that goes into the body for each slot, and behind the slots what nobody reads.
  struct Inward : Batch<capacity> {
    Vectors direction;
    Floats weight;
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
  double inward_weight(std::size_t slot) const { return inward_.weight[slot]; }
  Vec3 inward(std::size_t slot) const { return inward_.direction[slot]; }

 private:
  Walking walking_;
  Sent sent_;
  Lit lit_;
  Inward inward_;
};

}  // namespace translucube
