#include "renderer/light/lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace translucube {

using std::numbers::pi;

namespace {

/// Two sines of half the angle, squared: exact where the angle is small.
double spread_of(double angle) {
  const double s = std::sin(0.5 * angle);
  return 2 * s * s;
}

}  // namespace

Sun::Sun(Vec3 towards, double angular_diameter_rad, Rgb irradiance)
    : direction(direction_of(towards)), spread(spread_of(0.5 * angular_diameter_rad)) {
  // Of a cone about the normal: pi sin^2 of its half-angle.
  radiance = irradiance * static_cast<float>(1 / (pi * spread * (2 - spread)));
}

double AreaLight::area() const {
  return (outline == Outline::disc ? pi : 4) * half_width * half_height;
}

double AreaLight::bounding_radius() const {
  return outline == Outline::disc ? half_width : std::hypot(half_width, half_height);
}

bool AreaLight::reaches_unit_sphere() const {
  const double height = -dot(center, normal);  // of the origin above its plane
  if (std::fabs(height) >= 1) return false;
  const Vec3 below = -center - height * normal;  // from its centre to below the origin
  const double u = std::fabs(dot(below, x)), v = std::fabs(dot(below, y));
  const double outside = outline == Outline::disc ? std::fmax(0, std::hypot(u, v) - half_width)
                                                  : std::hypot(std::fmax(0, u - half_width),
                                                               std::fmax(0, v - half_height));
  return std::hypot(outside, height) < 1;
}

Rgb AreaLight::seen(Vec3 p, Vec3 d) const {
  const double facing = dot(d, normal);
  if (facing >= 0) return {};
  const double t = dot(center - p, normal) / facing;
  if (!(t > 0)) return {};
  const Vec3 from_center = p + t * d - center;
  const double u = dot(from_center, x) / half_width, v = dot(from_center, y) / half_height;
  const bool within =
      outline == Outline::disc ? u * u + v * v < 1 : std::fabs(u) < 1 && std::fabs(v) < 1;
  return within ? radiance : Rgb{};
}

double Lighting::Cone::pdf(Vec3 d) const {
  return spread >= 2 || length_squared(d - axis) < 2 * spread ? 1 / (2 * pi * spread) : 0;
}

Vec3 Lighting::Cone::draw(Sample2 u) const {
  const double below = u.u * spread;  // 1 - cos
  const double sine = std::sqrt(below * (2 - below)), phi = 2 * pi * u.v;
  return Frame(axis).to_world({sine * std::cos(phi), sine * std::sin(phi), 1 - below});
}

/// The directions in which the lamp is seen from anywhere in the body's bounding sphere.
Lighting::Cone Lighting::cone_of(const AreaLight& lamp) {
  const double distance = length(lamp.center);
  const double reach = 1 + lamp.bounding_radius();
  const Vec3 axis = distance > 0 ? lamp.center * (1 / distance) : Vec3{0, 0, 1};
  const double angle = distance > reach ? std::asin(reach / distance) : pi;
  const double facing = std::fmax(0.1, -dot(axis, lamp.normal));
  const double solid_angle =
      std::fmin(2 * pi, lamp.area() * facing / std::fmax(distance * distance, 1e-12));
  constexpr double rounding = 1e-6;
  return {axis, std::fmin(2, spread_of(angle) * (1 + rounding)), 0,
          lamp.radiance * static_cast<float>(solid_angle)};
}

Lighting::Lighting(Environment environment, std::vector<Sun> suns,
                   std::vector<AreaLight> area_lights, EnvironmentSide side)
    : environment_(std::move(environment)),
      suns_(std::move(suns)),
      area_lights_(std::move(area_lights)),
      side_(side) {
  for (const Sun& sun : suns_)
    cones_.push_back({sun.direction, sun.spread, 0,
                      sun.radiance * static_cast<float>(pi * sun.spread * (2 - sun.spread))});
  for (const AreaLight& lamp : area_lights_) cones_.push_back(cone_of(lamp));
  // What each brings to a sphere, and never so little that something is hardly ever looked for.
  Rgb around;
  if (const auto* even = std::get_if<UniformEnvironment>(&environment_))
    around = even->radiance * static_cast<float>(pi);
  else
    around = std::get<ImageEnvironment>(environment_).irradiance_by_order({0, 1, 0})[0];
  double total = std::fmax(0, luminance(around));
  const bool dark = total == 0;
  for (Cone& cone : cones_) total += cone.chance = 0.25 * luminance(cone.irradiance);
  const double least = 0.1 / static_cast<double>(cones_.size() + 1);
  double lamps = 0;
  for (Cone& cone : cones_) {
    cone.chance = total > 0 ? std::fmax(least, cone.chance / total) : least;
    lamps += cone.chance;
  }
  environment_chance_ = dark && !cones_.empty() ? 0 : std::fmax(least, 1 - lamps);
  const double sum = environment_chance_ + lamps;
  environment_chance_ /= sum;
  for (Cone& cone : cones_) cone.chance /= sum;
}

const UniformEnvironment* Lighting::uniform() const {
  return cones_.empty() ? std::get_if<UniformEnvironment>(&environment_) : nullptr;
}

void Lighting::add_lamps(Vec3 direction, EnvironmentValue& value) const {
  value.pdf *= environment_chance_;
  for (const Cone& cone : cones_) value.pdf += cone.chance * cone.pdf(direction);
  if (hides(direction)) return;
  for (const Sun& sun : suns_)
    if (sun.covers(direction)) value.radiance += sun.radiance;
}

EnvironmentValue Lighting::environment_from(Vec3 direction) const {
  if (const auto* image = std::get_if<ImageEnvironment>(&environment_))
    return image->value_from(direction);
  return {hides(direction) ? Rgb{} : std::get<UniformEnvironment>(environment_).radiance,
          1 / (4 * pi)};
}

EnvironmentValue Lighting::value_from(Vec3 direction) const {
  EnvironmentValue value = environment_from(direction);
  add_lamps(direction, value);
  return value;
}

void Lighting::look_up(EnvironmentBatch& batch) const {
  if (const auto* image = std::get_if<ImageEnvironment>(&environment_))
    batch.look_up(*image);
  else
    for (std::size_t i = 0; i < batch.size; ++i)
      batch.value[i] = environment_from(batch.direction[i]);
  if (cones_.empty()) return;
  for (std::size_t i = 0; i < batch.size; ++i) add_lamps(batch.direction[i], batch.value[i]);
}

EnvironmentSample Lighting::sample_environment(Sample2 u) const {
  if (const auto* image = std::get_if<ImageEnvironment>(&environment_)) return image->sample(u);
  const Cone everywhere{{0, 0, 1}, 2, 1, {}};
  const Vec3 direction = everywhere.draw(u);
  return {direction, environment_from(direction)};
}

EnvironmentSample Lighting::sample(Sample2 u) const {
  if (cones_.empty()) return sample_environment(u);
  EnvironmentSample sample;
  double rest = u.u;
  if (rest < environment_chance_) {
    sample = sample_environment({rest / environment_chance_, u.v});
  } else {
    rest -= environment_chance_;
    std::size_t i = 0;
    while (i + 1 < cones_.size() && rest >= cones_[i].chance) rest -= cones_[i++].chance;
    sample.direction = cones_[i].draw({std::fmin(1, rest / cones_[i].chance), u.v});
    sample.value = environment_from(sample.direction);
  }
  add_lamps(sample.direction, sample.value);
  return sample;
}

std::vector<EnvironmentSample> Lighting::sample(std::span<const Sample2> u) const {
  const auto* image = std::get_if<ImageEnvironment>(&environment_);
  if (cones_.empty() && image != nullptr) return image->sample(u);
  std::vector<EnvironmentSample> samples;
  samples.reserve(u.size());
  for (const Sample2& numbers : u) samples.push_back(sample(numbers));
  return samples;
}

std::vector<EnvironmentSample> Lighting::sample_each(std::size_t count, Rng& rng) const {
  std::vector<Sample2> numbers;
  numbers.reserve(count);
  const auto n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i)
    numbers.push_back({(static_cast<double>(i) + rng.uniform()) / n, rng.uniform()});
  return sample(numbers);
}

std::array<Rgb, 3> Lighting::irradiance_by_order(Vec3 n) const {
  std::array<Rgb, 3> orders;
  if (const auto* image = std::get_if<ImageEnvironment>(&environment_))
    orders = image->irradiance_by_order(n);
  else
    orders[0] = std::get<UniformEnvironment>(environment_).radiance *
                static_cast<float>(side_ == EnvironmentSide::all ? pi : pi / 2);
  for (const Cone& cone : cones_) {
    if (hides(cone.axis)) continue;
    // The clamped cosine in Legendre polynomials: 1/4, 1/2, 5/16.
    const auto c = static_cast<float>(dot(n, cone.axis));
    orders[0] += cone.irradiance * 0.25f;
    orders[1] += cone.irradiance * (0.5f * c);
    orders[2] += cone.irradiance * (0.3125f * (1.5f * c * c - 0.5f));
  }
  return orders;
}

}  // namespace translucube
