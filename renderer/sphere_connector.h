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
#include <vector>

#include "renderer/collector.h"
#include "renderer/exit_batch.h"
#include "renderer/sphere_exit.h"

namespace translucube {

/// For the bodies that do not connect.
struct NoConnector {
  NoConnector(const Scene&, Collector&, std::uint64_t) {}
  static constexpr bool active() { return false; }
  static constexpr double margin() { return 0; }
  void start(Path&) {}
  void connect(Path&) {}
  double pdf(const Path&) const { return 0; }
  void flush() {}
};

class SphereConnector {
 public:
  /// The scene: a smooth sphere with scatterers inside. `key` seeds the choice of lights.
  SphereConnector(const Scene& scene, Collector& collector, std::uint64_t key);

  /// Whether there is anything to look for: light that differs between directions.
  bool active() const { return environment_ != nullptr; }
  /// Mean free paths below the surface where vertices are visited one by one: light that goes
  /// straight out from deeper ones is left to the walk, which meets the sun at random (at 3 the
  /// untrimmed relMSE of S100 is five times as large).
  double margin() const { return active() ? 4 : 0; }

  /// Before the first connection of a path: its walk starts at path.p.
  void start(Path& path);
  /// From path.p, where it comes along path.d; before its new direction is chosen.
  void connect(Path& path);
  /// Of a path that arrived at path.p straight from path.vertex: the density of the direction in
  /// which it goes on outside, over the chance that connect() looked there; 0: it never does.
  double pdf(const Path& path) const;
  /// Collects what is under way.
  void flush() {
    flush_near();
    flush_far();
  }

  /// What a walk that leaves at a place with normal n carries of the light that is expected there.
  Rgb expected(Vec3 n, std::uint32_t walk_index) const {
    const Walk& walk = walks_[walk_index];
    const auto c = static_cast<float>(dot(n, walk.axis));
    return walk.expected[0] + walk.expected[1] * c + walk.expected[2] * legendre2(c);
  }

 private:
  /// Beyond this optical distance the far side of the body is left to the walk.
  static constexpr double longest_way = 4;
  /// Fall of the chance to connect with the optical depth.
  static constexpr double falling = 0.5;

  /// By symmetry the whole of an isotropic walk may be turned about the radius of its first vertex.
  struct Walk {
    Vec3 axis;                    ///< that radius, unit
    std::array<Rgb, 3> expected;  ///< orders of the expected light, averaged about it
  };
  /// What a connection needs to be collected.
  struct Waiting {
    Vec3 p, d;
    double length;
    float weight;
    std::uint32_t pixel, walk, light;
  };
  struct Queue {
    ExitBatch batch;
    std::array<Waiting, ExitBatch::capacity> waiting;
  };

  /// The share of the expected light that a walk carries. What is carried is a control variate:
  /// with all of it a dense clear body has the least noise (a third of what .7 leaves), with half
  /// of it an absorbing one. It is the same for all absorbers, so that one traced image serves each
  /// with the bits of its own.
  static constexpr float carried_share = 0.7f;
  static float legendre2(float c) { return 1.5f * c * c - 0.5f; }
  double chance(Vec3 p) const;
  bool reaches_far(const SphereExits& exits) const;
  ExitMedium exit_medium() const {
    return {static_cast<float>(ior_), static_cast<float>(medium_.sigma_s),
            static_cast<float>(medium_.g)};
  }
  /// Whether all that leaves on the near branch is found by connecting.
  bool near_alone() const { return medium_.g == 0; }
  void push(Queue& queue, const Waiting& vertex, double rho, double pdf) const;
  void flush_near();
  void flush_far();
  void collect_balanced(Queue& queue, ExitBranch branch);
  void collect_near(Queue& queue);

  Collector& collector_;
  const ImageEnvironment* environment_;
  Medium medium_;
  double ior_;
  float carried_;  ///< radiance to irradiance
  Rng rng_;
  std::vector<EnvironmentSample> lights_;
  LightStrata strata_;
  std::vector<Walk> walks_;
  Queue near_, far_;
};

}  // namespace translucube
