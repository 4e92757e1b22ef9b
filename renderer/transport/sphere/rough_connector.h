#pragma once

// Scattering vertices under a rough sphere look for light through the boundary
// (rough_exits_batch.h): each connects to a light of the tile's list by one collision with a
// microfacet, weighted by the balance heuristic (Veach 1995) against the walk that comes there by
// itself. What collides more often on its way out looks for light at the collisions.

#include <array>
#include <span>

#include "renderer/light/light_list.h"
#include "renderer/transport/collector.h"
#include "renderer/transport/sphere/rough_exits_batch.h"
#include "renderer/transport/sphere/sphere_walk.h"

namespace translucube {

class RoughConnector {
 public:
  /// The scene: a rough sphere with scatterers inside. Nothing is looked for if the list is empty.
  RoughConnector(const Scene& scene, Collector& collector, const LightList& lights);

  bool active() const { return !lights_.empty(); }
  /// The body, and which of its collisions look for light.
  WalkMedium walk_medium() const { return {medium_, active(), margin, falling}; }

  void start(Path&) {}
  /// Looks for light from collisions of walks; a vertex's slot is the index of its path.
  void connect(const SphereWalk::Vertices& vertices, std::span<const Path> paths);
  /// Collects what is under way.
  void flush();

  /// A path straight from path.vertex to the boundary, where it leaves towards `light` with a
  /// density `pdf` by its first collision.
  void push_way(const Path& path, Vec3 light, double pdf);
  /// Tells, for the ways pushed and in their order, the density with which they go on towards the
  /// light over the chance that connect() looked there; 0: it never does. Forgets them.
  const RoughWays::Floats& weigh_ways();

 private:
  /// Mean free paths below the surface where vertices are visited one by one: little light goes
  /// straight out from deeper ones.
  static constexpr float margin = 3;
  /// Fall of the chance to connect with the optical depth.
  static constexpr float falling = 0.5f;

  struct Waiting {
    double length;
    float weight;
    std::uint32_t pixel, light;
  };

  const Lighting& lighting_;
  Collector& collector_;
  const LightList& lights_;
  Medium medium_;
  RoughExitMedium exit_;
  RoughConnections connections_;
  std::array<Waiting, RoughConnections::capacity> waiting_;
  RoughWays ways_;
  RoughWays::Floats walked_;  ///< the ways' densities, by the walk, over the chance to connect
};

}  // namespace translucube
