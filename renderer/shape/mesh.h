#pragma once

#include <memory>
#include <span>

#include "renderer/shape/distance_grid.h"
#include "renderer/shape/shape.h"
#include "renderer/shape/triangle_mesh.h"

namespace translucube {

struct MeshGeometry;

/// A triangle, counter-clockwise seen from outside.
struct Facet {
  Vec3 a, b, c, normal;

  /// Whether a ray from inside passes through it, wherever else it passes (Moeller and Trumbore
  /// 1997).
  bool lets_out(Vec3 p, Vec3 d) const {
    const Vec3 ab = b - a, ac = c - a, across = cross(d, p - a);
    const double volume = dot(d, cross(ab, ac));
    const double u = dot(ac, across), v = -dot(ab, across);
    return volume > 0 && u >= 0 && v >= 0 && u + v <= volume;
  }
};

/// A closed triangle mesh, intersected by Embree (embree_mesh.cpp).
class Mesh {
 public:
  explicit Mesh(std::shared_ptr<const MeshGeometry> geometry);

  bool convex() const;
  bool inside(Vec3 p) const;
  double clearance(Vec3 p) const { return distance_bounds(p).least; }
  /// Bounds of the distance to the surface, at the cost of a look at a table; a finer one takes its
  /// samples more often.
  DistanceBounds distance_bounds(Vec3 p) const;
  DistanceBounds finer_distance_bounds(Vec3 p) const;
  /// Closer bounds, where the distance is known to be at most `most`, at the cost of some rays.
  DistanceBounds distance(Vec3 p, double most) const;
  bool intersect_outside(Vec3 p, Vec3 d, Hit& hit) const;
  bool intersect_inside(Vec3 p, Vec3 d, double t_max, Hit& hit) const;

  const Facet& facet(std::uint32_t face) const { return facets_[face]; }
  /// The faces that share a vertex with one.
  std::span<const std::uint32_t> neighbours(std::uint32_t face) const;
  /// A face that is about the nearest.
  std::uint32_t face_near(Vec3 p) const;

 private:
  std::shared_ptr<const MeshGeometry> geometry_;
  std::span<const Facet> facets_;  ///< of the geometry
};

/// A mesh in its own unit, ready to intersect, and where it was.
struct BuiltMesh {
  Mesh mesh;
  Vec3 center;        ///< of the bounding box, in the file's unit
  double radius = 1;  ///< of the bounding sphere about the centre: the body's unit
};
/// Builds Embree's tree (embree_mesh.cpp). The mesh must be closed.
BuiltMesh build_mesh(const TriangleMesh& mesh);

}  // namespace translucube
