#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "renderer/light/lighting.h"
#include "renderer/scene/scene.h"
#include "renderer/transport/boundary/ways_out.h"
#include "renderer/transport/collector.h"

namespace translucube {

/// Scattering vertices in a body with smooth flat faces look for the bright part of the
/// environment: each connects to one light of the tile's list by all ways out that
/// find_ways_out() finds. Where scattering has no direction the light is chosen by about what it
/// brings, and what is found so is left out where the walk meets it; elsewhere the balance
/// heuristic (Veach 1995) weights both. The walk asks which ways were found only where it meets
/// bright light.
template <class Shape>
class FacetConnector {
 public:
  FacetConnector(const Scene& scene, const Shape& shape, Collector& collector, std::uint64_t key)
      : shape_(shape),
        lighting_(scene.environment),
        collector_(collector),
        medium_(std::get<ScatteringInterior>(scene.interior).medium),
        ior_(std::get<SmoothInterface>(scene.interface).ior) {
    if (!active()) return;
    Rng rng(key);
    for (const EnvironmentSample& light : lighting_.sample_each(drawn, rng))
      if (is_bright(light.value)) lights_.push_back(light);
    share_ = static_cast<double>(lights_.size()) / drawn;
  }

  /// Whether there is anything to look for: light that differs between directions.
  bool active() const { return !lighting_.uniform(); }
  /// Mean free paths below the surface where collisions are visited one by one.
  double margin() const { return active() ? 3 : 0; }
  void start(Path&) {}
  void flush() {}

  /// From a collision at path.p where the light came along path.d; before its new direction.
  void connect(const Path& path, Rng& rng) {
    if (lights_.empty()) return;
    if (!alone()) {
      const double chance = chance_at(path.p);
      if (rng.uniform() >= chance) return;
      const EnvironmentSample& light =
          lights_[static_cast<std::size_t>(rng.uniform() * static_cast<double>(lights_.size()))];
      return follow(path, light, share_, chance * light.value.pdf);
    }
    const Choice choice = choose(path.p, rng);
    const double chance = std::fmin(1, choice.brought / enough);
    if (rng.uniform() >= chance) return;
    const double weight = share_ / chance;
    // Most of it is told by the plane near by; what the body makes of it, now and then.
    const bool follows = rng.uniform() < exactly;
    if (choice.way.distance > 0 && (!follows || exactly < 1))
      collect(path, *choice.light, choice.way,
              weight / choice.pdf * (follows ? 1 - 1 / exactly : 1));
    if (follows) follow(path, *choice.light, weight / exactly, choice.pdf);
  }

  /// Of what meets light after the flight from `from`, inside along `d`, out where the normal is n:
  /// the share that is the walk's.
  double share_of_walk(const Path::Vertex& from, Vec3 d, Vec3 n,
                       const EnvironmentValue& light) const {
    if (!is_bright(light)) return 1;
    const Vec3 out = *refract(-d, -n, 1 / ior_);
    double share = 1;
    find_ways_out(shape_, ior_, from.p, out, [&](const WayOut& way) {
      constexpr double same = 1e-9;
      if (length_squared(way.d - d) > same * same) return;
      const double walked = density({d, from.flight, n}, out, from.phase);
      share = alone() ? 0 : walked / (walked + chance_at(from.p) * light.pdf);
    });
    return share;
  }

  static constexpr std::uint32_t drawn = 512;
  /// Densities from which a light is bright, over that of light from everywhere.
  static constexpr double bright = 1;
  static constexpr double falling = 0.5;

 private:
  struct Choice {
    const EnvironmentSample* light;
    double pdf;      ///< with which it was looked for, per solid angle
    double brought;  ///< about what all lights bring
    WayOut way;      ///< through the plane near by; of length 0 where there is none
  };
  /// Resampled importance sampling (Talbot, Cline, Egbert 2005) by what comes through the plane
  /// near by.
  Choice choose(Vec3 p, Rng& rng) const {
    const NearPlane plane = plane_near(shape_, p);
    const double optical = medium_.sigma_s * plane.depth;
    double total = 0, chosen_weight = 0;
    const EnvironmentSample* chosen = nullptr;
    for (int i = 0; i < candidates; ++i) {
      // One of each of as many equal parts of the list.
      const auto at = static_cast<std::size_t>((i + rng.uniform()) *
                                               static_cast<double>(lights_.size()) / candidates);
      const EnvironmentSample& light = lights_[at];
      const double cosine = dot(light.direction, plane.n);
      double weight = least;
      if (cosine > 0) {
        const double cos_t = std::sqrt(1 - (1 - cosine * cosine) / (ior_ * ior_));
        weight += std::exp(-optical / cos_t) * cosine / cos_t;
      }
      total += weight;
      if (rng.uniform() * total < weight) chosen = &light, chosen_weight = weight;
    }
    Choice choice{
        chosen, chosen->value.pdf * chosen_weight * candidates / total, total / candidates, {}};
    if (const auto d = way_to(chosen->direction, plane.n, ior_))
      choice.way = {*d, std::fmax(plane.depth, 1e-9) / dot(*d, plane.n), plane.n};
    return choice;
  }
  static constexpr int candidates = 8;
  /// What the lights bring from where they are always looked for, relative to a point at the
  /// surface of a half space and light from straight above.
  static constexpr double enough = 0.05;
  /// How often the ways out are followed: in a mesh each takes some rays.
  static constexpr double exactly = std::is_same_v<Shape, Mesh> ? 0.4 : 1;

  /// Collects what all ways out to a light bring; `looked_for`: the density of having looked there.
  void follow(const Path& path, const EnvironmentSample& light, double weight, double looked_for) {
    ++collector_.counters().light_samples;
    find_ways_out(shape_, ior_, path.p, light.direction, [&](const WayOut& way) {
      Hit hit;
      if (!shape_.convex() &&
          shape_.intersect_outside(path.p + way.distance * way.d, light.direction, hit))
        return;
      const double walked =
          alone() ? 0 : density(way, light.direction, medium_.phase(dot(path.d, way.d)));
      collect(path, light, way, weight / (looked_for + walked));
    });
  }

  void collect(const Path& path, const EnvironmentSample& light, const WayOut& way, double weight) {
    const double out = (1 - fresnel(dot(light.direction, way.n), ior_)) *
                       density(way, light.direction, medium_.phase(dot(path.d, way.d)));
    const Rgb radiance =
        light.value.radiance + lighting_.from_near(path.p + way.distance * way.d, light.direction);
    collector_.collect(path.pixel, path.length + way.distance, path.tint,
                       radiance * static_cast<float>(path.weight * weight * out));
  }

  static constexpr double least = 0.02;

  bool alone() const { return medium_.g == 0; }
  static bool is_bright(const EnvironmentValue& light) {
    return light.pdf * 4 * std::numbers::pi > bright;
  }
  double chance_at(Vec3 p) const {
    return std::exp(-falling * medium_.sigma_s * std::fmax(0.0, shape_.clearance(p)));
  }
  /// Of the walk's way out, per solid angle outside.
  double density(const WayOut& way, Vec3 light, double phase) const {
    return phase * std::exp(-medium_.sigma_s * way.distance) * dot(light, way.n) /
           (ior_ * ior_ * dot(way.d, way.n));
  }

  const Shape& shape_;
  const Lighting& lighting_;
  Collector& collector_;
  Medium medium_;
  double ior_;
  std::vector<EnvironmentSample> lights_;
  double share_ = 0;  ///< of the lights drawn, those that are bright
};

}  // namespace translucube
