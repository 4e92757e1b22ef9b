#include <algorithm>
#include <cmath>
#include <numbers>

#include "picture/image_io.h"
#include "picture/light_map.h"
#include "renderer/light/environment_cache.h"
#include "renderer/scene/scene.h"
#include "renderer/shape/file/mesh_file.h"
#include "renderer/shape/mesh.h"

namespace translucube {
namespace {

struct PlacedShape {
  AnyShape shape;
  Vec3 center_mm;
  double unit_mm;
  double back;  ///< least z, in units
  std::optional<MeshReport> mesh = {};
};

PlacedShape make_shape(const SphereObject& sphere) { return {Sphere{}, {}, sphere.radius_mm, -1}; }

PlacedShape make_shape(const MeshObject& object) {
  try {
    const auto [mesh, report] = read_mesh(object.file);
    const BuiltMesh built = build_mesh(mesh);
    const double back =
        std::ranges::min(mesh.vertices, {}, [](Vec3 v) { return v.z; }).z - built.center.z;
    return {built.mesh, built.center, built.radius, back / built.radius, report};
  } catch (const MeshUnavailable& error) {
    throw SceneError(SceneError::Part::object, error.what(), true);
  } catch (const MeshError& error) {
    throw SceneError(SceneError::Part::object, error.what());
  }
}

/// A body within a box of these extents, made in units of the box's bounding sphere.
template <class Make>
PlacedShape make_flat_faced(Vec3 extents_mm, Make&& make) {
  const double unit = 0.5 * length(extents_mm);
  return {make(extents_mm * (0.5 / unit), unit), {}, unit, -0.5 * extents_mm.z / unit};
}

PlacedShape make_shape(const PlateObject& plate) {
  return make_flat_faced({plate.width_mm, plate.height_mm, plate.thickness_mm},
                         [](Vec3 half, double) { return make_box(half); });
}

PlacedShape make_shape(const BoxObject& box) {
  return make_flat_faced({box.width_mm, box.height_mm, box.depth_mm},
                         [](Vec3 half, double) { return make_box(half); });
}

PlacedShape make_shape(const WedgeObject& wedge) {
  return make_flat_faced(
      {wedge.width_mm, wedge.height_mm, wedge.thick_mm},
      [&](Vec3 half, double unit) { return make_wedge(half, wedge.thin_mm / unit); });
}

PlacedShape make_shape(const BowlObject& bowl) {
  const double inner = 1 - bowl.thickness_mm / bowl.radius_mm;
  return {Bowl(inner), {0, 0.5 * bowl.radius_mm, 0}, bowl.radius_mm, -1};
}

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

Environment make_environment(const EnvironmentSpec& spec, EnvironmentSide side,
                             EnvironmentCache& cache) {
  if (const auto* constant = std::get_if<ConstantEnvironmentSpec>(&spec.source))
    return UniformEnvironment{constant->radiance * static_cast<float>(spec.scale)};
  try {
    return *cache.get(std::get<ImageEnvironmentSpec>(spec.source).file,
                      std::fmod(spec.rotation_deg, 360) * std::numbers::pi / 180, spec.scale, side);
  } catch (const ImageUnavailable& error) {
    throw SceneError(SceneError::Part::environment, error.what(), true);
  } catch (const ImageError& error) {
    throw SceneError(SceneError::Part::environment, error.what());
  }
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

void check_mesh(const std::filesystem::path& file) {
  try {
    read_mesh(file);
  } catch (const MeshUnavailable& error) {
    throw SceneError(SceneError::Part::object, error.what(), true);
  } catch (const MeshError& error) {
    throw SceneError(SceneError::Part::object, error.what());
  }
}

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
  const PlacedShape placed = std::visit([](const auto& o) { return make_shape(o); }, spec.object);
  const double unit = placed.unit_mm;
  const auto to_body = [&](Vec3 p) { return (p - placed.center_mm) * (1 / unit); };
  auto scene = std::make_shared<Scene>();
  scene->width = spec.width;
  scene->height = spec.height;
  scene->seed = spec.seed;
  scene->unit_mm = unit;
  scene->shape = placed.shape;
  scene->mesh = placed.mesh;
  scene->interface = make_interface(spec.material);
  if (const auto& film = spec.material.oil_film)
    scene->oiled =
        OiledPart{film->normal, (film->offset_mm - dot(placed.center_mm, film->normal)) / unit};
  Material traced = spec.material;
  traced.coefficients.sigma_a_peak = least_absorption(spec);
  scene->interior = make_interior(traced, unit);
  if (spec.backdrop) scene->backdrop = make_backdrop(*spec.backdrop, placed);
  scene->environment = make_environment(
      spec.environment, spec.backdrop ? EnvironmentSide::front : EnvironmentSide::all,
      environments ? *environments : own);
  scene->camera =
      make_camera(spec, to_body(spec.camera.position_mm), to_body(spec.camera.target_mm));
  scene->camera_inside =
      std::visit([&](const auto& s) { return s.inside(scene->camera.position); }, scene->shape);
  if (scene->backdrop && scene->camera.position.z <= scene->backdrop->z)
    throw SceneError(SceneError::Part::camera, "the camera is behind the backdrop");
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
