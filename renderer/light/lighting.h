#pragma once

// All the light around a body: an environment, and lamps beside it. Directions are drawn in
// proportion to about what each of them brings to the body; what a lamp at a finite distance sends
// along such a direction depends on the place, and is asked for there.

#include <span>
#include <vector>

#include "renderer/light/environment.h"
#include "renderer/light/environment_batch.h"

namespace translucube {

/// A disc in the sky, evenly bright.
struct Sun {
  Vec3 direction;     ///< towards its centre, unit
  double spread = 0;  ///< 1 - cos of its angular radius
  Rgb radiance;

  /// From its irradiance on a surface that faces it.
  Sun(Vec3 towards, double angular_diameter_rad, Rgb irradiance);
  bool covers(Vec3 d) const { return length_squared(d - direction) < 2 * spread; }
};

/// A flat lamp at a finite distance, in the body's coordinates, that shines evenly from its
/// normal's side, hides nothing and reflects nothing.
struct AreaLight {
  enum class Outline { disc, rectangle };
  Outline outline = Outline::disc;
  Vec3 center, normal;                     ///< unit
  Vec3 x, y;                               ///< unit, in its plane, perpendicular
  double half_width = 1, half_height = 1;  ///< along x and y; a disc's radius, both
  Rgb radiance;

  /// What it sends to p, seen from there along d (unit).
  Rgb seen(Vec3 p, Vec3 d) const;
  double area() const;
  double bounding_radius() const;
  bool reaches_unit_sphere() const;
};

class Lighting {
 public:
  Lighting() = default;
  Lighting(UniformEnvironment environment) : Lighting(Environment(environment)) {}
  Lighting(ImageEnvironment environment) : Lighting(Environment(std::move(environment))) {}
  Lighting(Environment environment, std::vector<Sun> suns = {},
           std::vector<AreaLight> area_lights = {}, EnvironmentSide side = EnvironmentSide::all);

  /// Where light is the same from all directions there is nothing to look for: else null.
  const UniformEnvironment* uniform() const;

  /// Draws a direction. Nearby u.u give nearby directions. Its value as value_from() has it.
  EnvironmentSample sample(Sample2 u) const;
  /// Many directions, quickest where u.u ascends.
  std::vector<EnvironmentSample> sample(std::span<const Sample2> u) const;
  /// One in each of `count` equal parts of the density.
  std::vector<EnvironmentSample> sample_each(std::size_t count, Rng& rng) const;
  /// The light from far away along a direction, and the density of drawing it.
  EnvironmentValue value_from(Vec3 direction) const;
  void look_up(EnvironmentBatch& batch) const;
  /// The light of the lamps near by, at p from along d: beside value_from().
  Rgb from_near(Vec3 p, Vec3 d) const {
    Rgb sum;
    for (const AreaLight& lamp : area_lights_) sum += lamp.seen(p, d);
    return sum;
  }
  bool has_near() const { return !area_lights_.empty(); }
  /// As ImageEnvironment has it; of what is not an image about so.
  std::array<Rgb, 3> irradiance_by_order(Vec3 n) const;

 private:
  /// Directions about an axis, drawn evenly.
  struct Cone {
    Vec3 axis;
    double spread;  ///< 1 - cos of its half-angle
    double chance;
    Rgb irradiance;  ///< about what comes from there, on a surface that faces it
    double pdf(Vec3 d) const;
    Vec3 draw(Sample2 u) const;
  };
  static Cone cone_of(const AreaLight& lamp);
  void add_lamps(Vec3 direction, EnvironmentValue& value) const;
  bool hides(Vec3 d) const { return is_hidden(side_, d); }
  EnvironmentValue environment_from(Vec3 direction) const;
  EnvironmentSample sample_environment(Sample2 u) const;

  Environment environment_;
  std::vector<Sun> suns_;
  std::vector<AreaLight> area_lights_;
  EnvironmentSide side_ = EnvironmentSide::all;
  std::vector<Cone> cones_;        ///< of the suns, then of the area lights
  double environment_chance_ = 1;  ///< that a direction is drawn from the environment
};

}  // namespace translucube
