#pragma once

// Scattering vertices under a smooth sphere look for light through the boundary: each connects to a
// direction drawn from the environment, weighted by the balance heuristic (Veach 1995) against the
// walk's own way out. Of the expected light at a place of the surface, its irradiance, a share is
// left to the walk, which carries it without noise, and only the rest is connected (a control
// variate).

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
  /// Mean free paths below the surface where vertices are visited one by one: little light goes
  /// straight out from deeper ones.
  double margin() const { return active() ? 3 : 0; }

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

  /// What the walk carries of the light that is expected to leave at a place with normal n.
  Rgb expected(Vec3 n) const { return environment_->irradiance(n) * carried_by_walk; }

 private:
  static constexpr std::size_t light_count = 2048;
  /// Chosen by relMSE x CPU on the peers' materials: without absorption the walk's share has no
  /// noise, with it some.
  static constexpr float carried_by_walk = 0.5f / 3.14159265f;
  /// Beyond this optical distance the far side of the body is left to the walk.
  static constexpr double longest_way = 4;
  /// Fall of the chance to connect with the optical depth.
  static constexpr double falling = 0.5;

  struct Waiting {
    Vec3 p, d;
    double length;
    float weight;
    std::uint32_t pixel, light;
  };
  struct Queue {
    ExitBatch batch;
    std::array<Waiting, ExitBatch::capacity> waiting;
  };

  double chance(Vec3 p) const;
  bool reaches_far(const SphereExits& exits) const;
  void push(Queue& queue, const Waiting& vertex, double rho, double pdf) const;
  void collect(Queue& queue, ExitBranch branch);
  void collect(const Waiting& from, double distance, Vec3 normal, double share);
  void flush_near();
  void flush_far();

  Collector& collector_;
  const ImageEnvironment* environment_;
  Medium medium_;
  double ior_;
  std::vector<EnvironmentSample> lights_;
  Queue near_, far_;
};

}  // namespace translucube
