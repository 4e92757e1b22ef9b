#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/request/read_request.h"

namespace translucube::api {
namespace {

using nlohmann::json;

void read_map(const std::string& file, const std::string& pointer, const Catalog& catalog,
              EnvironmentRequest& out, Faults& faults) {
  auto path = resolve_file(file, pointer, catalog, faults);
  if (path && check_file(check_environment, *path, pointer, catalog, faults))
    out.source = FileEnvironment{std::move(*path)};
}

void read_environment(const json& value, const std::string& pointer, const Catalog& catalog,
                      EnvironmentRequest& out, Faults& faults) {
  FieldReader environment(value, pointer, faults);
  environment.exclusive({"image", "constant", "harmonics", "file", "upload"}, Presence::optional);
  if (auto image = environment.string("image")) {
    if (catalog.environments.contains(*image)) {
      out.source = NamedEnvironment{std::move(*image)};
    } else {
      std::vector<std::string> names;
      for (const auto& [name, file] : catalog.environments) names.push_back(name);
      environment.fault("image",
                        "there is no environment of this name; there are: " + name_list(names));
    }
  }
  if (const auto constant = environment.triple("constant", radiance_range))
    out.source = ConstantEnvironment{*constant};
  if (const auto file = environment.string("file"))
    read_map(*file, environment.pointer_to("file"), catalog, out, faults);
  // Harmonics go below 0 where others make up for it.
  constexpr Range signed_range{-radiance_range.high, radiance_range.high};
  if (auto harmonics = environment.triples("harmonics", signed_range, {1, 4, 9, 16}))
    out.source = HarmonicsEnvironment{std::move(*harmonics)};
  if (auto upload = environment.string("upload"))
    if (check_upload(UploadKind::environment, *upload, environment.pointer_to("upload"), catalog,
                     faults))
      out.source = UploadedEnvironment{std::move(*upload)};
  if (const auto rotation = environment.number("rotation_deg", {})) out.rotation_deg = *rotation;
  if (const auto scale = environment.number("scale", radiance_range)) out.scale = *scale;
  environment.refuse_unknown_keys();
}

/// v / |v|, or zero for zero.
Vec3 direction(Vec3 v) { return v == Vec3{} ? v : direction_of(v); }

void read_camera(const json& value, const std::string& pointer, CameraRequest& out,
                 Faults& faults) {
  const std::size_t faults_before = faults.count();
  FieldReader camera(value, pointer, faults);
  if (const auto position = camera.triple("position_mm", position_range))
    out.position_mm = *position;
  if (const auto target = camera.triple("target_mm", position_range)) out.target_mm = *target;
  if (const auto up = camera.triple("up", {})) out.up = *up;
  if (const auto vfov = camera.number("vfov_deg", {0, 180, true, true})) out.vfov_deg = *vfov;
  camera.refuse_unknown_keys();
  if (faults.count() > faults_before) return;

  const Vec3 view = direction(vector(out.target_mm) - vector(out.position_mm));
  const Vec3 up = direction(vector(out.up));
  const bool has_view = length_squared(view) > 0, has_up = length_squared(up) > 0;
  if (!has_view) faults.add(pointer, "position_mm and target_mm must differ");
  if (!has_up) camera.fault("up", "must not be zero");
  // Below a sine of 1e-6 the picture's roll is mostly rounding.
  if (has_view && has_up && length(cross(view, up)) < 1e-6)
    camera.fault("up", "must not be parallel to the view direction");
}

}  // namespace

void read_scene(const json& value, const std::string& pointer, const Catalog& catalog,
                RenderRequest& out, Faults& faults) {
  FieldReader scene(value, pointer, faults);
  if (const json* object = scene.find("object"))
    read_object(*object, scene.pointer_to("object"), catalog, out.object, faults);
  if (const json* environment = scene.find("environment"))
    read_environment(*environment, scene.pointer_to("environment"), catalog, out.environment,
                     faults);
  if (const json* backdrop = scene.find("backdrop"))
    read_backdrop(*backdrop, scene.pointer_to("backdrop"), out.backdrop, faults);
  if (const json* lights = scene.find("lights"))
    read_lights(*lights, scene.pointer_to("lights"), out.lights, faults);
  if (const json* ground = scene.find("ground"))
    read_ground(*ground, scene.pointer_to("ground"), out.ground, faults);
  if (out.ground && out.backdrop) scene.fault("ground", "cannot be where there is a backdrop");
  if (const json* camera = scene.find("camera"))
    read_camera(*camera, scene.pointer_to("camera"), out.camera, faults);
  scene.refuse_unknown_keys();
}

}  // namespace translucube::api
