#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "renderer/shape/file/gltf/accessor.h"
#include "renderer/shape/file/gltf/placement.h"
#include "renderer/shape/file/polygon_mesh.h"

namespace translucube {
namespace {

using namespace gltf;

constexpr double mm_per_metre = 1000;

/// Extensions that a document may require, of which the shape of a body does not depend.
bool changes_no_shape(std::string_view extension) {
  constexpr std::array<std::string_view, 6> prefixes{"KHR_materials_", "KHR_texture_",
                                                     "EXT_texture_",   "KHR_lights_",
                                                     "KHR_xmp",        "KHR_animation_pointer"};
  return extension == "KHR_mesh_quantization" ||  // read (accessor.cpp)
         std::ranges::any_of(prefixes, [&](auto prefix) { return extension.starts_with(prefix); });
}

void check_asset(const Value& document) {
  const Value asset = document.at("asset");
  if (!asset.at("version").text().starts_with("2.")) asset.at("version").fail("must be 2.0");
  if (const auto least = asset.find("minVersion"); least && least->text() != "2.0")
    least->fail("must be 2.0");
  const auto required = document.find("extensionsRequired");
  for (std::size_t i = 0; required && i < required->size(); ++i)
    if (const Value name = required->at(i); !changes_no_shape(name.text()))
      name.fail("requires " + name.text().substr(0, 64) + ", which is not read");
}

/// The triangles of a primitive, as corners (specification 2.0, 3.7.2.1).
class Triangles {
 public:
  static constexpr std::uint64_t list = 4, strip = 5, fan = 6;

  Triangles(std::uint64_t mode, std::uint64_t corners) : mode_(mode), corners_(corners) {}
  std::uint64_t count() const {
    return mode_ == list ? corners_ / 3 : corners_ < 3 ? 0 : corners_ - 2;
  }
  std::array<std::uint64_t, 3> at(std::uint64_t i) const {
    if (mode_ == list) return {3 * i, 3 * i + 1, 3 * i + 2};
    if (mode_ == strip) return {i, i + 1 + i % 2, i + 2 - i % 2};
    return {i + 1, i + 2, 0};
  }

 private:
  std::uint64_t mode_, corners_;
};

class SceneReader {
 public:
  explicit SceneReader(const Container& container)
      : document_(container.document), accessors_(container) {}

  PolygonMesh read() {
    check_asset(document_);
    mesh_.place = "triangle";
    // Nodes that are still to come, with what places them. A chain of them may be long.
    struct Visit {
      Value reference;
      Placement parent;
    };
    std::vector<Visit> visits;
    const auto add = [&](const Value& list, const Placement& parent) {
      for (std::size_t i = list.size(); i-- > 0;) visits.push_back({list.at(i), parent});
    };
    if (const auto roots = default_scene().find("nodes")) add(*roots, {});
    const auto nodes = document_.find("nodes");
    std::vector<bool> visited(nodes ? nodes->size() : 0);
    while (!visits.empty()) {
      const auto [reference, parent] = visits.back();
      visits.pop_back();
      const Value node = referred(document_, "nodes", reference);
      if (visited[reference.integer()])
        reference.fail("names a node for the second time: nodes are a tree");
      visited[reference.integer()] = true;
      const Placement placement = parent.of(placement_of(node));
      if (const auto mesh = node.find("mesh")) add_mesh(node, *mesh, placement);
      if (const auto children = node.find("children")) add(*children, placement);
    }
    if (mesh_.faces() == 0) throw MeshError("the default scene has no triangle");
    finish();
    return std::move(mesh_);
  }

 private:
  Value default_scene() const {
    if (const auto scene = document_.find("scene")) return referred(document_, "scenes", *scene);
    const auto scenes = document_.find("scenes");
    if (!scenes || scenes->size() == 0) document_.fail("has no scene");
    return scenes->at(std::uint64_t{0});
  }

  void add_mesh(const Value& node, const Value& reference, const Placement& placement) {
    if (const auto skin = node.find("skin"))
      skin->fail("meshes that a skeleton moves are not read: apply its pose and export again");
    if (const auto extensions = node.find("extensions"))
      if (const auto instances = extensions->find("EXT_mesh_gpu_instancing"))
        instances->fail("instances are not read: export each as a node");
    const Value mesh = referred(document_, "meshes", reference);
    for (const Value* owner : {&node, &mesh})
      if (const auto weights = owner->find("weights"))
        for (std::size_t i = 0; i < weights->size(); ++i)
          if (weights->at(i).number() != 0)
            weights->fail("morph targets are not read: apply them and export again");
    const Value primitives = mesh.at("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i) add_primitive(primitives.at(i), placement);
  }

  void add_primitive(const Value& primitive, const Placement& placement) {
    const auto given = primitive.find("mode");
    const std::uint64_t mode = given ? given->integer(Triangles::fan) : Triangles::list;
    if (mode < Triangles::list) return;  // points and lines bound nothing
    if (const auto extensions = primitive.find("extensions"))
      if (const auto draco = extensions->find("KHR_draco_mesh_compression"))
        draco->fail("compressed meshes are not read: export it without Draco");
    const Value position = primitive.at("attributes").at("POSITION");
    const Accessors::Points points = accessors_.points(position);
    const std::size_t base = mesh_.vertices.size();
    if (points.points.size() > std::numeric_limits<std::uint32_t>::max() - base)
      position.fail("makes more vertices than can be counted");
    for (const Vec3& p : points.points) {
      const Vec3 placed = mm_per_metre * placement.point(p);
      if (!std::isfinite(placed.x + placed.y + placed.z))
        primitive.fail("is placed where no number reaches");
      mesh_.vertices.push_back(placed);
    }
    note_rounding(points, placement);
    add_triangles(primitive, mode, points.points.size(), static_cast<std::uint32_t>(base),
                  placement.mirrors());
  }

  void add_triangles(const Value& primitive, std::uint64_t mode, std::size_t vertices,
                     std::uint32_t base, bool mirrored) {
    const auto reference = primitive.find("indices");
    std::vector<std::uint32_t> indices;
    if (reference) indices = accessors_.indices(*reference);
    const std::uint64_t corners = reference ? indices.size() : vertices;
    if (mode == Triangles::list && corners % 3 != 0)
      primitive.fail("has " + std::to_string(corners) + " corners of triangles: no multiple of 3");
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (indices[i] >= vertices)
        reference->fail("element " + std::to_string(i) + " is vertex " +
                        std::to_string(indices[i]) + ": there are " + std::to_string(vertices));
    const Triangles triangles(mode, corners);
    for (std::uint64_t t = 0; t < triangles.count(); ++t) {
      std::array<std::uint64_t, 3> corner = triangles.at(t);
      if (mirrored) std::swap(corner[1], corner[2]);
      for (const std::uint64_t c : corner)
        mesh_.corners.push_back(base + (reference ? indices[c] : static_cast<std::uint32_t>(c)));
      mesh_.ends.push_back(mesh_.corners.size());
      mesh_.places.push_back(static_cast<std::uint32_t>(mesh_.faces()));
    }
  }

  /// Points were rounded where they were stored, before they were placed.
  void note_rounding(const Accessors::Points& points, const Placement& placement) {
    double largest = 0;
    for (const Vec3& p : points.points)
      largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    const double stretch =
        std::max({length(placement.x), length(placement.y), length(placement.z)});
    rounded_off_ = std::max(rounded_off_, points.rounding * largest * stretch * mm_per_metre);
  }

  void finish() {
    double largest = 0;
    for (const Vec3& v : mesh_.vertices)
      largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    if (largest > 0) mesh_.rounding = std::max(mesh_.rounding, rounded_off_ / largest);
  }

  const Value document_;
  Accessors accessors_;
  PolygonMesh mesh_;
  double rounded_off_ = 0;  ///< at most, of a coordinate [mm]
};

}  // namespace

PolygonMesh parse_gltf(std::string_view bytes) {
  const Container container = open_container(bytes);
  return SceneReader(container).read();
}

}  // namespace translucube
