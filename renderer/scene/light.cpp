#include "renderer/scene/light.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "picture/image_io.h"
#include "picture/light_map.h"
#include "renderer/light/harmonics.h"

namespace translucube {
namespace {

constexpr double radians = std::numbers::pi / 180;

EnvironmentSide side_of(const SceneSpec& spec) {
  return spec.backdrop ? EnvironmentSide::front
         : spec.ground ? EnvironmentSide::above
                       : EnvironmentSide::all;
}

Environment make_environment(const EnvironmentSpec& spec, EnvironmentSide side,
                             EnvironmentCache& cache) {
  const double rotation = std::fmod(spec.rotation_deg, 360) * radians;
  if (const auto* constant = std::get_if<ConstantEnvironmentSpec>(&spec.source))
    return UniformEnvironment{constant->radiance * static_cast<float>(spec.scale)};
  if (const auto* harmonics = std::get_if<HarmonicsSpec>(&spec.source))
    return ImageEnvironment(image_of_harmonics(harmonics->coefficients), rotation, spec.scale,
                            side);
  try {
    return *cache.get(std::get<ImageEnvironmentSpec>(spec.source).file, rotation, spec.scale, side);
  } catch (const ImageUnavailable& error) {
    throw SceneError(SceneError::Part::environment, error.what(), true);
  } catch (const ImageError& error) {
    throw SceneError(SceneError::Part::environment, error.what());
  }
}

Rgb rgb(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// Adds a light to those of its kind.
class Lamps {
 public:
  Lamps(Vec3 center_mm, double unit_mm) : center_mm_(center_mm), unit_mm_(unit_mm) {}

  void operator()(const SunSpec& sun) {
    suns.emplace_back(sun.direction, sun.angular_diameter_deg * radians, rgb(sun.irradiance));
  }
  void operator()(const DiscSpec& disc) {
    const Vec3 normal = direction_of(disc.normal);
    const Frame frame(normal);
    const double radius = disc.radius_mm / unit_mm_;
    add({AreaLight::Outline::disc, place(disc.center_mm), normal, frame.x, frame.y, radius, radius,
         rgb(disc.radiance)});
  }
  void operator()(const RectangleSpec& rectangle) {
    const Vec3 normal = direction_of(rectangle.normal);
    const Vec3 across = cross(direction_of(rectangle.up), normal);
    if (!(length(across) > 1e-6))
      throw SceneError(SceneError::Part::lights, "a rectangle's up points along its normal");
    const Vec3 x = normalize(across);
    add({AreaLight::Outline::rectangle, place(rectangle.center_mm), normal, x, cross(normal, x),
         0.5 * rectangle.width_mm / unit_mm_, 0.5 * rectangle.height_mm / unit_mm_,
         rgb(rectangle.radiance)});
  }

  std::vector<Sun> suns;
  std::vector<AreaLight> areas;

 private:
  Vec3 place(Vec3 p_mm) const { return (p_mm - center_mm_) * (1 / unit_mm_); }
  void add(const AreaLight& lamp) {
    if (!std::isfinite(length_squared(lamp.center) + lamp.half_width + lamp.half_height))
      throw SceneError(SceneError::Part::lights, "a light is too far away or too large");
    if (lamp.reaches_unit_sphere())
      throw SceneError(SceneError::Part::lights,
                       "a light reaches into the sphere around the body: it must be outside");
    areas.push_back(lamp);
  }

  Vec3 center_mm_;
  double unit_mm_;
};

}  // namespace

Lighting make_lighting(const SceneSpec& spec, Vec3 center_mm, double unit_mm,
                       EnvironmentCache& cache) {
  Lamps lamps(center_mm, unit_mm);
  for (const LightSpec& light : spec.lights) std::visit(lamps, light);
  const EnvironmentSide side = side_of(spec);
  return Lighting(make_environment(spec.environment, side, cache), std::move(lamps.suns),
                  std::move(lamps.areas), side);
}

double lowest_mm(const LightSpec& light, Vec3 n) {
  if (const auto* disc = std::get_if<DiscSpec>(&light)) {
    const double cosine = dot(direction_of(disc->normal), n);
    return dot(disc->center_mm, n) -
           disc->radius_mm * std::sqrt(std::fmax(0.0, 1 - cosine * cosine));
  }
  if (const auto* rectangle = std::get_if<RectangleSpec>(&light)) {
    const Vec3 normal = direction_of(rectangle->normal);
    const Vec3 x = normalize(cross(direction_of(rectangle->up), normal)), y = cross(normal, x);
    return dot(rectangle->center_mm, n) - 0.5 * rectangle->width_mm * std::fabs(dot(x, n)) -
           0.5 * rectangle->height_mm * std::fabs(dot(y, n));
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace translucube
