#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <variant>
#include <vector>

#include "renderer/base/vec.h"
#include "renderer/light/backdrop.h"
#include "renderer/optics/material.h"

namespace translucube {

struct SphereObject {
  double radius_mm = 20;  ///< centred at the origin
  friend bool operator==(const SphereObject&, const SphereObject&) = default;
};
struct MeshObject {
  std::filesystem::path file;  ///< of a format of shape/file/mesh_format.h, closed
  /// Whether its triangles stand for curved surfaces (shape/smooth); not given: if its file has
  /// normals that say so.
  std::optional<bool> smooth = {};
  friend bool operator==(const MeshObject&, const MeshObject&) = default;
};
/// A plate. As a box and a wedge, it has its bounding box centred at the origin.
struct PlateObject {
  double width_mm = 40, height_mm = 40, thickness_mm = 4;  ///< along x, y, z
  friend bool operator==(const PlateObject&, const PlateObject&) = default;
};
struct BoxObject {
  double width_mm = 28, height_mm = 28, depth_mm = 28;  ///< along x, y, z
  friend bool operator==(const BoxObject&, const BoxObject&) = default;
};
/// A plate with a flat back whose thickness rises from left (-x) to right.
struct WedgeObject {
  double width_mm = 40, height_mm = 40, thin_mm = 0, thick_mm = 10;
  friend bool operator==(const WedgeObject&, const WedgeObject&) = default;
};
/// Half of a spherical shell, open upwards (+y).
struct BowlObject {
  double radius_mm = 20, thickness_mm = 3;  ///< outer radius, of the wall
  friend bool operator==(const BowlObject&, const BowlObject&) = default;
};
/// A ring about y.
struct TorusObject {
  double major_mm = 14, minor_mm = 6;  ///< from the axis to the middle of the tube, of the tube
  friend bool operator==(const TorusObject&, const TorusObject&) = default;
};
/// A box with rounded edges.
struct RoundedBoxObject {
  double width_mm = 28, height_mm = 28, depth_mm = 28, edge_mm = 4;  ///< edge: radius, <= half
  friend bool operator==(const RoundedBoxObject&, const RoundedBoxObject&) = default;
};
/// A plate whose front (+z) has ridges along y, within these extents (shape/body/body.h).
struct ReliefObject {
  double width_mm = 40, height_mm = 40, depth_mm = 8;
  double sharpness = 0.5;     ///< of their edges: 0 sine, 1 upright walls
  double ridge_height = 0.5;  ///< share of the depth
  std::uint64_t ridges = 5;
  friend bool operator==(const ReliefObject&, const ReliefObject&) = default;
};
/// A sphere with smooth random bumps.
struct BlobObject {
  double radius_mm = 20;
  double bump = 0.3;  ///< their strength, [0, 1]
  double scale = 1;   ///< their size, in radii
  std::uint64_t seed = 1;
  friend bool operator==(const BlobObject&, const BlobObject&) = default;
};
/// A dragon of ours that stands along x and looks left (shape/body/dragon.cpp).
struct DragonObject {
  double length_mm = 44;  ///< from the nose to the tail
  friend bool operator==(const DragonObject&, const DragonObject&) = default;
};
using ObjectSpec =
    std::variant<SphereObject, MeshObject, PlateObject, BoxObject, WedgeObject, BowlObject,
                 TorusObject, RoundedBoxObject, ReliefObject, BlobObject, DragonObject>;

struct ImageEnvironmentSpec {
  std::filesystem::path file;  ///< lat-long, linear RGB
};
struct ConstantEnvironmentSpec {
  Rgb radiance{1, 1, 1};
};
/// Real spherical harmonics (light/harmonics.h).
struct HarmonicsSpec {
  std::vector<Rgb> coefficients;  ///< 1, 4, 9 or 16
};
struct EnvironmentSpec {
  std::variant<ConstantEnvironmentSpec, ImageEnvironmentSpec, HarmonicsSpec> source;
  double rotation_deg = 0;  ///< about +y, positive from +z towards +x
  double scale = 1;         ///< multiplies the radiance, >= 0
};

struct SunSpec {
  Vec3 direction{0, 1, 0};  ///< towards it, of any length but 0
  double angular_diameter_deg = 0.53;
  std::array<double, 3> irradiance{1, 1, 1};  ///< on a surface that faces it
  friend bool operator==(const SunSpec&, const SunSpec&) = default;
};
/// Flat lamps that shine evenly from their normal's side and hide nothing.
struct DiscSpec {
  Vec3 center_mm{0, 100, 0}, normal{0, -1, 0};
  double radius_mm = 20;
  std::array<double, 3> radiance{1, 1, 1};
  friend bool operator==(const DiscSpec&, const DiscSpec&) = default;
};
struct RectangleSpec {
  Vec3 center_mm{0, 100, 0}, normal{0, -1, 0}, up{0, 0, 1};  ///< the height lies along up
  double width_mm = 40, height_mm = 40;
  std::array<double, 3> radiance{1, 1, 1};
  friend bool operator==(const RectangleSpec&, const RectangleSpec&) = default;
};
using LightSpec = std::variant<SunSpec, DiscSpec, RectangleSpec>;

/// A wide diffuse plane below the body.
struct GroundSpec {
  double height_mm = -20;    ///< of y, at most that of the body's lowest point
  double reflectance = 0.5;  ///< [0, 1]
  friend bool operator==(const GroundSpec&, const GroundSpec&) = default;
};

struct CameraSpec {
  Vec3 position_mm{0, 0, 90}, target_mm{0, 0, 0}, up{0, 1, 0};
  double vfov_deg = 32;  ///< vertical field of view, (0, 180)
};

/// Keeps the path lengths, so that any absorber can be developed later (explorable.h).
struct Explorable {
  double densest_sigma_a = 0;  ///< what it will be developed for at most [1/mm]
};

/// Which light transport renders the body: the exact one, or the paper's approximation (dipole.h).
struct ExactTransport {};
struct DipoleModel {
  double opacity = 0;  ///< w: the material's scattering coordinate in the cube, [0, 1]
};
using LightModel = std::variant<ExactTransport, DipoleModel>;

/// All that the picture depends on, as plain values.
struct SceneSpec {
  Material material;
  LightModel model;
  /// Other absorptions of the same body, traced with it: a lane of the film for each, behind the
  /// material's own. Where one of them is finite, none changes what is traced.
  std::vector<Absorption> more_absorptions;
  std::optional<Explorable> explorable;
  ObjectSpec object;
  EnvironmentSpec environment;
  std::vector<LightSpec> lights;  ///< beside the environment
  std::optional<BackdropSpec> backdrop;
  std::optional<GroundSpec> ground;  ///< not with a backdrop
  CameraSpec camera;
  int width = 512, height = 512;
  std::uint64_t seed = 1;
};

/// A resource of the scene that cannot be used: unreadable image, open or empty mesh.
struct SceneError : std::runtime_error {
  enum class Part { object, environment, lights, ground, camera };
  Part part;
  bool unavailable;  ///< another try may help: what failed is the reading, not what is read
  SceneError(Part p, const std::string& what, bool may_help = false)
      : std::runtime_error(what), part(p), unavailable(may_help) {}
};

/// A scene ready to trace (scene.h): immutable, shared by threads.
struct Scene;
class EnvironmentCache;
/// Reads the resources, the environment by way of the cache if there is one. Throws SceneError.
std::shared_ptr<const Scene> build_scene(const SceneSpec& spec,
                                         EnvironmentCache* environments = nullptr);

/// Throws SceneError with the reason, which does not name the file, if the object cannot be made of
/// it (shape/file/mesh_file.h, shape/smooth/refine.h).
void check_mesh(const MeshObject& object);
/// Likewise of an environment's file (picture/light_map.h).
void check_environment(const std::filesystem::path& file);

}  // namespace translucube
