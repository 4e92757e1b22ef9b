#include <algorithm>
#include <cmath>
#include <numbers>

#include "picture/image_io.h"
#include "picture/light_map.h"
#include "renderer/scene/light.h"
#include "renderer/scene/placed_shape.h"

namespace translucube {
namespace {

Backdrop make_backdrop(const BackdropSpec& spec, const PlacedShape& placed) {
  const double unit = placed.unit_mm;
  return {spec.kind,
          spec.pattern,
          placed.back - std::fmax(contact_gap, spec.distance_mm / unit),
          -placed.center_mm.x / unit,
          -placed.center_mm.y / unit,
          spec.period_mm / unit,
          static_cast<float>(spec.light),
          static_cast<float>(spec.dark)};
}

Backdrop make_ground(const GroundSpec& spec, const PlacedShape& placed) {
  Backdrop ground;
  ground.kind = BackdropKind::print;
  ground.lies = true;
  ground.light = static_cast<float>(spec.reflectance);
  ground.height = (spec.height_mm - placed.center_mm.y) / placed.unit_mm;
  constexpr double rounding = 1e-6;  // of a body that is to stand on it
  if (!(ground.height <= placed.bottom + rounding))
    throw SceneError(SceneError::Part::ground, "the body reaches below the ground");
  ground.height = std::fmin(ground.height, placed.bottom - contact_gap);
  return ground;
}

/// Lamps and the camera are where the plane is seen from.
void check_plane(const SceneSpec& spec, const Scene& scene, const Vec3& center_mm) {
  if (!scene.backdrop) return;
  const char* name = spec.ground ? "ground" : "backdrop";
  const Vec3 n = scene.backdrop->normal();
  if (!(dot(scene.camera.position, n) > scene.backdrop->height))
    throw SceneError(
        SceneError::Part::camera,
        std::string("the camera is ") + (spec.ground ? "below the " : "behind the ") + name);
  const double height_mm = scene.backdrop->height * scene.unit_mm + dot(center_mm, n);
  for (const LightSpec& light : spec.lights)
    if (lowest_mm(light, n) < height_mm)
      throw SceneError(SceneError::Part::lights, std::string("a light reaches beyond the ") + name);
}

Camera make_camera(const SceneSpec& spec, Vec3 position, Vec3 target) {
  const Camera camera(position, target, spec.camera.up, spec.camera.vfov_deg, spec.width,
                      spec.height);
  if (!std::isfinite(length_squared(camera.forward) + length_squared(camera.right)))
    throw SceneError(SceneError::Part::camera,
                     "its position and target are one point as far away as they are");
  return camera;
}

/// The least absorption that is developed from one tracing: a body that it leaves open is traced
/// open.
double least_absorption(const SceneSpec& spec) {
  if (spec.explorable) return 0;
  double least = spec.material.coefficients.sigma_a_peak;
  for (const Absorption& more : spec.more_absorptions) least = std::min(least, more.sigma_a_peak);
  return least;
}

/// The paper's model, where it says something else than the transport: not of an empty body nor of
/// a black one.
void use_dipole(const DipoleModel& model, const SceneSpec& spec, Scene& scene) {
  if (spec.explorable) throw std::invalid_argument("the dipole has no path lengths to keep");
  if (std::holds_alternative<BlackInterior>(scene.interior) ||
      std::holds_alternative<ClearInterior>(scene.interior))
    return;
  if (std::holds_alternative<DensePigmentInterior>(scene.interior))
    throw std::invalid_argument("the dipole has no pigments of infinite density");
  if (scene.camera_inside)
    throw SceneError(SceneError::Part::camera,
                     "the camera is inside the body, where the dipole model knows no light");
  std::vector<Absorption> absorptions{
      {spec.material.absorber, spec.material.coefficients.sigma_a_peak}};
  absorptions.insert(absorptions.end(), spec.more_absorptions.begin(), spec.more_absorptions.end());
  // A sphere of radius 1 and what is bounded by it.
  constexpr double reach = 2;
  scene.interior =
      make_dipole(spec.material, scene.interface, scene.unit_mm, model.opacity, reach, absorptions);
}

}  // namespace

void check_environment(const std::filesystem::path& file) {
  const auto refuse = [&](std::string why, bool unavailable) {
    const std::string name = file.string() + ": ";
    if (why.starts_with(name)) why.erase(0, name.size());
    throw SceneError(SceneError::Part::environment, why, unavailable);
  };
  try {
    read_light_map(file);
  } catch (const ImageUnavailable& error) {
    refuse(error.what(), true);
  } catch (const ImageError& error) {
    refuse(error.what(), false);
  }
}

std::shared_ptr<const Scene> build_scene(const SceneSpec& spec, EnvironmentCache* environments) {
  EnvironmentCache own;
  const PlacedShape placed = place_shape(spec.object);
  const double unit = placed.unit_mm;
  const auto to_body = [&](Vec3 p) { return (p - placed.center_mm) * (1 / unit); };
  auto scene = std::make_shared<Scene>();
  scene->width = spec.width;
  scene->height = spec.height;
  scene->seed = spec.seed;
  scene->unit_mm = unit;
  scene->shape = placed.shape;
  scene->refinement = placed.refinement;
  scene->mesh = placed.mesh;
  scene->interface = make_interface(spec.material);
  if (const auto& film = spec.material.oil_film)
    scene->oiled =
        OiledPart{film->normal, (film->offset_mm - dot(placed.center_mm, film->normal)) / unit};
  Material traced = spec.material;
  traced.coefficients.sigma_a_peak = least_absorption(spec);
  scene->interior = make_interior(traced, unit);
  if (spec.backdrop) scene->backdrop = make_backdrop(*spec.backdrop, placed);
  if (spec.ground) scene->backdrop = make_ground(*spec.ground, placed);
  scene->environment =
      make_lighting(spec, placed.center_mm, unit, environments ? *environments : own);
  scene->camera =
      make_camera(spec, to_body(spec.camera.position_mm), to_body(spec.camera.target_mm));
  scene->camera_inside =
      std::visit([&](const auto& s) { return s.inside(scene->camera.position); }, scene->shape);
  check_plane(spec, *scene, placed.center_mm);
  if (const auto* model = std::get_if<DipoleModel>(&spec.model)) use_dipole(*model, spec, *scene);
  if (scene->camera_inside && !is_open(scene->interior))
    throw SceneError(SceneError::Part::camera, "the camera is inside an opaque body");
  scene->lanes = {make_lane(spec.material, scene->interior, unit)};
  for (const Absorption& more : spec.more_absorptions) {
    Material other = spec.material;
    other.absorber = more.absorber;
    other.coefficients.sigma_a_peak = more.sigma_a_peak;
    scene->lanes.push_back(make_lane(other, scene->interior, unit));
  }
  if (spec.explorable) {
    const auto* walk = std::get_if<ScatteringInterior>(&scene->interior);
    scene->spread = BinSpread(
        length_bins(spec.explorable->densest_sigma_a * unit, walk ? walk->medium.sigma_s : 0));
  }
  return scene;
}

}  // namespace translucube
