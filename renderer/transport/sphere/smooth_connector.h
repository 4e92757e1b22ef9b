#pragma once

// Scattering vertices under a smooth sphere look for light through the boundary.
//
// Each connects to a light drawn from the environment. On the near branch of an isotropic medium
// that is the whole estimate: the light is chosen by about what it brings, and the walk that leaves
// there brings nothing of its own. Elsewhere, on the far side and where scattering has a direction,
// the balance heuristic (Veach 1995) weights the connection against the walk's own way out.
//
// The light that is expected at a place of the surface, its irradiance, is a control variate: a
// share of it is carried by the walk to where it leaves, which without absorption has no noise but
// that of the place, and taken away again where vertices connect. Of the place only the distance
// from the walk's first vertex matters. A sphere with an isotropic walk inside may be turned about
// the radius of that vertex: what is carried is the mean over all turns, and the lights to choose
// from are seen from sixteen of them.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "renderer/transport/collector.h"
#include "renderer/transport/sphere/smooth_exits.h"
#include "renderer/transport/sphere/smooth_lights_batch.h"
#include "renderer/transport/sphere/sphere_walk.h"

namespace translucube {

/// What bodies have instead that do not connect.
struct NoConnector {
  NoConnector(const Scene&, Collector&, std::uint64_t) {}
  static constexpr bool active() { return false; }
  void start(Path&) {}
  double pdf(const Path&) const { return Path::not_looked_for; }
  void flush() {}
};

class SmoothConnector {
 public:
  /// The scene: a smooth sphere with scatterers inside. `key` seeds the choice of lights.
  SmoothConnector(const Scene& scene, Collector& collector, std::uint64_t key);

  /// Whether there is anything to look for: light that differs between directions.
  bool active() const { return !lighting_.uniform(); }
  /// The body, and which of its collisions look for light.
  WalkMedium walk_medium() const { return {medium_, active(), margin, falling}; }

  /// Before the first connection of a path: its walk starts at path.p.
  void start(Path& path);
  /// Looks for light from collisions of walks; a vertex's slot is the index of its path.
  void connect(const SphereWalk::Vertices& vertices, std::span<const Path> paths);
  /// For a path that arrived straight from path.vertex, the density of the direction in which it
  /// goes on outside, over the chance that connect() looked there; 0: it never does.
  double pdf(const Path& path) const;
  /// Collects what is under way.
  void flush() {
    flush_near();
    flush_far();
  }

  /// The share of the expected light that a walk carries which balances its own way out with
  /// connections: on the far side, and where scattering has a direction.
  static constexpr float far_share = 0.7f;
  /// The light that is expected at a place with normal n, as radiance.
  Rgb expected(Vec3 n, std::uint32_t walk_index) const {
    const Walk& walk = walks_[walk_index];
    const auto c = static_cast<float>(dot(n, walk.axis));
    return walk.expected[0] + walk.expected[1] * c + walk.expected[2] * legendre2(c);
  }

 private:
  /// Mean free paths below the surface where vertices are visited one by one: light that goes
  /// straight out from deeper ones is left to the walk, which meets the sun at random (at 3 the
  /// untrimmed relMSE of S100 is five times as large).
  static constexpr float margin = 4;
  /// Fall of the chance to connect with the optical depth.
  static constexpr float falling = 0.5f;
  /// Beyond this optical distance the far side of the body is left to the walk.
  static constexpr double longest_way = 4;

  /// By symmetry the whole of an isotropic walk may be turned about the radius of its first vertex.
  struct Walk {
    Vec3 axis;                    ///< that radius, unit
    std::array<Rgb, 3> expected;  ///< orders of the expected light, averaged about it
  };
  /// What a connection needs to be collected.
  struct Waiting {
    double length;
    float weight;
    std::uint32_t pixel, walk, light;
  };
  struct Queue {
    SmoothExitBatch batch;
    std::array<Waiting, SmoothExitBatch::capacity> waiting;
  };

  /// The share of the expected light that the walk carries to where it leaves near by, by relMSE on
  /// materials of all albedos: with absorption it becomes a noise of its own, and connecting finds
  /// more of the light. Each lane has its own; which paths are traced does not depend on it.
  float carried_share(const Lane& lane) const;
  static float legendre2(float c) { return 1.5f * c * c - 0.5f; }
  bool reaches_far(const SmoothExits& exits) const;
  SmoothExitMedium exit_medium() const {
    return {static_cast<float>(ior_), static_cast<float>(medium_.sigma_s),
            static_cast<float>(medium_.g)};
  }
  /// Whether all that leaves on the near branch is found by connecting.
  bool near_alone() const { return medium_.g == 0; }
  /// A vertex and what it takes to collect it; `light`: of the list, `pdf`: with which it is looked
  /// for, per solid angle.
  static void push(Queue& queue, const SphereWalk::Vertices& vertices, std::size_t i,
                   const Path& path, float weight, std::uint32_t light, Vec3 direction, double pdf);
  /// Where light on its way out brings a share of the vertex's light.
  struct WayOut {
    double share, distance;
    Vec3 normal;  ///< where it leaves
  };
  /// What find_exits() found for a vertex, in double precision where single did not.
  std::optional<WayOut> way_out(const SmoothExitBatch& batch, std::size_t i, Vec3 towards,
                                ExitBranch branch, Division division) const;
  /// Where a point lies when the walk is turned so that the light chosen for vertex i is in place.
  static Vec3 turned(const SmoothExitBatch& batch, std::size_t i, Vec3 p);
  void flush_near();
  void flush_far();
  void collect_balanced(Queue& queue, ExitBranch branch);
  void collect_near(Queue& queue);

  Collector& collector_;
  const Lighting& lighting_;
  Medium medium_;
  double ior_;
  Rng rng_;
  std::vector<EnvironmentSample> lights_;
  LightStrata strata_;
  std::vector<Walk> walks_;
  Queue near_, far_;
};

}  // namespace translucube
