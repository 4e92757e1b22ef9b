#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "renderer/light/light_list.h"
#include "renderer/optics/fresnel.h"
#include "renderer/optics/microfacet.h"
#include "renderer/optics/microsurface.h"
#include "renderer/scene/scene.h"
#include "renderer/transport/boundary/ways_out.h"
#include "renderer/transport/collector.h"

namespace translucube {

/// Scattering vertices look for light through a rough boundary of any shape, as RoughConnector does
/// in a sphere: about where the smooth surface would refract towards a light of the tile's list, a
/// microfacet is drawn that sends the light in; where the ray from there meets the boundary it
/// leaves by one collision. The balance heuristic (Veach 1995) weights this against the walk that
/// comes there by itself.
template <class Shape>
class MicrofacetConnector {
 public:
  /// Nothing is looked for if the list is empty.
  MicrofacetConnector(const Scene& scene, const Shape& shape, Collector& collector,
                      const LightList& lights)
      : shape_(shape),
        lighting_(scene.environment),
        collector_(collector),
        lights_(lights),
        medium_(std::get<ScatteringInterior>(scene.interior).medium),
        ior_(std::get<RoughInterface>(scene.interface).ior),
        ggx_(std::get<RoughInterface>(scene.interface).microfacets) {}

  bool active() const { return !lights_.empty(); }
  /// Mean free paths below the surface where collisions are visited one by one.
  double margin() const { return active() ? 3 : 0; }
  void start(Path&) {}
  void flush() {}

  /// From a collision at path.p where the light came along path.d; before its new direction.
  void connect(const Path& path, Rng& rng) {
    const double chance = chance_at(path.p);
    if (rng.uniform() >= chance) return;
    ++collector_.counters().light_samples;
    const auto light = static_cast<std::uint32_t>(rng.bits() & (LightList::size - 1));
    const Vec3 direction = lights_.direction[light];
    const auto n = place_towards(path.p, direction);
    if (!n) return;
    const Frame there(*n);
    const Vec3 towards = there.to_local(direction);
    const Vec3 m = ggx_.sample_visible(towards, rng.uniform2());
    if (dot(towards, m) <= 0) return;
    const Vec3 d = there.to_world(-*refract(towards, m, ior_));
    const double chosen = density_of(towards, m) * chance * lights_.pdf[light];

    Hit hit;
    if (!shape_.intersect_inside(path.p, d, infinity, hit)) return;
    const Frame inside(-hit.n);
    const Vec3 w = inside.to_local(-d), wi = inside.to_local(direction);
    const Vec3 facet = facet_between(w, wi, 1 / ior_);
    const double w_m = dot(w, facet), wi_m = dot(wi, facet);
    if (w.z <= 0 || wi.z >= 0 || w_m <= 0 || wi_m >= 0) return;
    const double walked = medium_.phase(dot(path.d, d)) * std::exp(-medium_.sigma_s * hit.t) *
                          ggx_.visible_d(w, facet) * refraction_jacobian(1 / ior_, w_m, wi_m);
    const double depth = -std::log(rng.uniform_positive()) / collision_rate(ggx_, -w);
    const double leaves =
        (1 - fresnel(w_m, 1 / ior_)) * escape_from(ggx_, {wi.x, wi.y, -wi.z}, depth_beyond(depth));
    const double share = walked * leaves / (chosen + walked);
    if (!(share > 0)) return;
    Hit other;
    if (!shape_.convex() && shape_.intersect_outside(hit.p, direction, other)) return;
    const Rgb radiance = lights_.radiance[light] + lighting_.from_near(hit.p, direction);
    collector_.collect(path.pixel, path.length + hit.t, path.tint,
                       radiance * static_cast<float>(path.weight * share));
  }

  /// A path straight from path.vertex to the boundary, where it leaves towards `light` with a
  /// density `pdf` by its first collision.
  void push_way(const Path& path, Vec3 light, double pdf) {
    const Path::Vertex& from = path.vertex;
    ways_.push_back(0);
    const auto n = place_towards(from.p, light);
    if (!n) return;
    const Frame there(*n);
    const Vec3 towards = there.to_local(light), wi = there.to_local(-path.d);
    const Vec3 m = facet_between(towards, wi, ior_);
    if (dot(towards, m) <= 0 || dot(wi, m) >= 0) return;
    const double walked = from.phase * std::exp(-medium_.sigma_s * from.flight) * pdf;
    ways_.back() = static_cast<float>(walked / (chance_at(from.p) * density_of(towards, m)));
  }
  /// Tells, for the ways pushed and in their order, the density with which they go on towards the
  /// light over the chance that connect() looked there; 0: it never does. Forgets them.
  const std::vector<float>& weigh_ways() {
    weighed_.swap(ways_);
    ways_.clear();
    return weighed_;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  /// How often a vertex at the surface looks for light, and the fall of that with optical depth, by
  /// relMSE x CPU.
  static constexpr double often = 0.5, falling = 0.25;
  static constexpr double least_cosine = 1e-3;  // of the light above the surface there

  double chance_at(Vec3 p) const {
    return often * std::exp(-falling * medium_.sigma_s * std::fmax(0.0, shape_.clearance(p)));
  }

  /// The surface's normal about where the smooth one refracts towards the light. Any will do that
  /// depends on nothing but the vertex and the light.
  std::optional<Vec3> place_towards(Vec3 p, Vec3 light) const {
    Hit hit;
    const Vec3 d = way_to(light, normal_near(shape_, p), ior_).value_or(light);
    if (!shape_.intersect_inside(p, d, infinity, hit) || dot(hit.n, light) <= least_cosine)
      return {};
    return hit.n;
  }

  /// The density of the way from inside through the facet m to the light above.
  double density_of(Vec3 towards, Vec3 m) const {
    const double light_m = dot(towards, m);
    const double cos_t = std::sqrt(1 - (1 - light_m * light_m) / (ior_ * ior_));
    return ggx_.visible_d(towards, m) * refraction_jacobian(ior_, light_m, -cos_t);
  }

  const Shape& shape_;
  const Lighting& lighting_;
  Collector& collector_;
  const LightList& lights_;
  Medium medium_;
  double ior_;
  Ggx ggx_;
  std::vector<float> ways_, weighed_;
};

}  // namespace translucube
