#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "api/request/read_request.h"

namespace translucube::api {
namespace {

using nlohmann::json;

constexpr std::size_t most_lights = 64;
constexpr Range size_range{1e-6, 1e9};  // mm

/// A lamp in the manner of a studio's: so wide that shadows are soft; a white face that looks at it
/// has the radiance 1.
SunSpec soft_light(Vec3 direction) {
  constexpr double pi = 3.141592653589793;
  return {direction, 10, {pi, pi, pi}};
}

struct Preset {
  const char* name;
  Vec3 direction;
};
constexpr std::array presets{Preset{"front", {-0.4, 0.6, 1}}, Preset{"side", {-1, 0.3, 0.2}},
                             Preset{"back", {0.3, 0.5, -1}}};

void read_vector(FieldReader& reader, const char* key, const Range& range, Vec3& out) {
  if (const auto triple = reader.triple(key, range)) out = vector(*triple);
}

void read_direction(FieldReader& reader, const char* key, Vec3& out) {
  const auto triple = reader.triple(key, {});
  if (!triple) return;
  out = vector(*triple);
  if (out == Vec3{}) reader.fault(key, "must not be zero");
}

void read_number(FieldReader& reader, const char* key, const Range& range, double& out) {
  if (const auto number = reader.number(key, range)) out = *number;
}

void read_color(FieldReader& reader, const char* key, std::array<double, 3>& out) {
  if (const auto color = reader.triple(key, radiance_range)) out = *color;
}

SunSpec read_sun(FieldReader& reader) {
  SunSpec sun;
  read_direction(reader, "direction", sun.direction);
  read_number(reader, "angular_diameter_deg", {0.05, 180}, sun.angular_diameter_deg);
  read_color(reader, "irradiance", sun.irradiance);
  return sun;
}

DiscSpec read_disc(FieldReader& reader) {
  DiscSpec disc;
  read_vector(reader, "center_mm", position_range, disc.center_mm);
  read_direction(reader, "normal", disc.normal);
  read_number(reader, "radius_mm", size_range, disc.radius_mm);
  read_color(reader, "radiance", disc.radiance);
  return disc;
}

RectangleSpec read_rectangle(FieldReader& reader) {
  RectangleSpec rectangle;
  read_vector(reader, "center_mm", position_range, rectangle.center_mm);
  read_direction(reader, "normal", rectangle.normal);
  read_direction(reader, "up", rectangle.up);
  read_number(reader, "width_mm", size_range, rectangle.width_mm);
  read_number(reader, "height_mm", size_range, rectangle.height_mm);
  read_color(reader, "radiance", rectangle.radiance);
  const Vec3 normal = rectangle.normal, up = rectangle.up;
  if (normal != Vec3{} && up != Vec3{} &&
      length(cross(direction_of(normal), direction_of(up))) < 1e-6)
    reader.fault("up", "must not be parallel to the normal");
  return rectangle;
}

std::optional<LightSpec> read_light(const json& value, const std::string& pointer, Faults& faults) {
  FieldReader reader(value, pointer, faults);
  const auto type = reader.string("type", Presence::required);
  if (!type) return {};
  std::optional<LightSpec> light;
  if (*type == "sun")
    light = read_sun(reader);
  else if (*type == "disc")
    light = read_disc(reader);
  else if (*type == "rectangle")
    light = read_rectangle(reader);
  else
    reader.fault("type", "must be one of sun, disc, rectangle");
  if (light) reader.refuse_unknown_keys();
  return light;
}

}  // namespace

void read_lights(const json& value, const std::string& pointer, std::vector<LightSpec>& out,
                 Faults& faults) {
  if (value.is_string()) {
    const auto found = std::ranges::find(presets, value.get<std::string>(), &Preset::name);
    if (found == presets.end())
      return faults.add(pointer, "must be a list of lights, or one of front, side, back");
    out = {soft_light(found->direction)};
    return;
  }
  if (!value.is_array())
    return faults.add(pointer, "must be a list of lights, or one of front, side, back");
  if (value.size() > most_lights)
    return faults.add(pointer,
                      "must not have more than " + std::to_string(most_lights) + " lights");
  out.clear();
  for (std::size_t i = 0; i < value.size(); ++i)
    if (const auto light = read_light(value[i], pointer + "/" + std::to_string(i), faults))
      out.push_back(*light);
}

void read_ground(const json& value, const std::string& pointer, std::optional<GroundSpec>& out,
                 Faults& faults) {
  if (value.is_boolean() && !value.get<bool>()) return out.reset();
  if (!value.is_object()) return faults.add(pointer, "must be false or an object");
  FieldReader reader(value, pointer, faults);
  GroundSpec ground = out.value_or(GroundSpec{});
  read_number(reader, "height_mm", position_range, ground.height_mm);
  read_number(reader, "reflectance", unit_range, ground.reflectance);
  reader.refuse_unknown_keys();
  out = ground;
}

}  // namespace translucube::api
