#include "renderer/scene/placed_shape.h"

#include <algorithm>

#include "renderer/base/recently_used.h"
#include "renderer/shape/body/body.h"
#include "renderer/shape/file/mesh_file.h"
#include "renderer/shape/mesh.h"

namespace translucube {
namespace {

PlacedShape make_shape(const SphereObject& sphere) {
  return {Sphere{}, {}, sphere.radius_mm, -1, -1};
}

PlacedShape place(const TriangleMesh& mesh, const std::optional<Refinement>& refinement) {
  const BuiltMesh built = build_mesh(mesh);
  const auto least = [&](double Vec3::*axis) {
    return (std::ranges::min(mesh.vertices, {}, axis).*axis - built.center.*axis) / built.radius;
  };
  return {built.mesh, built.center, built.radius, least(&Vec3::z), least(&Vec3::y), refinement};
}

/// Does what reads a mesh, and tells of it as of the scene's object.
template <class Read>
auto reading_mesh(Read&& read) {
  try {
    return read();
  } catch (const MeshUnavailable& error) {
    throw SceneError(SceneError::Part::object, error.what(), true);
  } catch (const MeshError& error) {
    throw SceneError(SceneError::Part::object, error.what());
  }
}

PlacedShape make_shape(const MeshObject& object) {
  return reading_mesh([&] {
    auto [mesh, report] = read_mesh(object.file);
    const auto refinement = make_smooth(mesh, object.smooth);
    PlacedShape placed = place(mesh, refinement);
    placed.mesh = report;
    return placed;
  });
}

/// A body within a box of these extents, made in units of the box's bounding sphere.
template <class Make>
PlacedShape make_flat_faced(Vec3 extents_mm, Make&& make) {
  const double unit = 0.5 * length(extents_mm);
  return {make(extents_mm * (0.5 / unit), unit),
          {},
          unit,
          -0.5 * extents_mm.z / unit,
          -0.5 * extents_mm.y / unit,
          {}};
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
  return {Bowl(inner), {0, 0.5 * bowl.radius_mm, 0}, bowl.radius_mm, -1, -1};
}

BodyMesh make_body(const TorusObject& torus) { return make_torus(torus.major_mm, torus.minor_mm); }

BodyMesh make_body(const RoundedBoxObject& box) {
  return make_rounded_box({box.width_mm, box.height_mm, box.depth_mm}, box.edge_mm);
}

BodyMesh make_body(const ReliefObject& relief) {
  return make_relief({relief.width_mm, relief.height_mm, relief.depth_mm}, relief.sharpness,
                     relief.ridge_height, static_cast<std::uint32_t>(relief.ridges));
}

BodyMesh make_body(const BlobObject& blob) {
  return make_blob(blob.radius_mm, blob.bump, blob.scale, blob.seed);
}

BodyMesh make_body(const DragonObject& dragon) { return make_dragon(dragon.length_mm); }

template <class Object>
concept MadeBody = requires(const Object& object) {
  make_body(object);
};

/// Bodies of our own depend on their numbers alone, and take longer to make than a first pass of
/// another material does: those that were asked for last are kept.
PlacedShape remembered(const ObjectSpec& object, BodyMesh (*make)(const ObjectSpec&)) {
  constexpr std::uint64_t most_triangles = 1'000'000;
  static RecentlyUsed<ObjectSpec, PlacedShape> bodies(most_triangles);
  if (const auto known = bodies.find(object)) return *known;
  const TriangleMesh mesh = refined(make(object));
  const auto placed = std::make_shared<const PlacedShape>(place(mesh, std::nullopt));
  bodies.keep(object, placed, mesh.triangles.size());
  return *placed;
}

template <MadeBody Object>
PlacedShape make_shape(const Object& object) {
  return remembered(object, [](const ObjectSpec& o) { return make_body(std::get<Object>(o)); });
}

}  // namespace

PlacedShape place_shape(const ObjectSpec& object) {
  return std::visit([](const auto& o) { return make_shape(o); }, object);
}

void check_mesh(const MeshObject& object) {
  reading_mesh([&] {
    TriangleMesh mesh = read_mesh(object.file).mesh;
    make_smooth(mesh, object.smooth);
  });
}

}  // namespace translucube
