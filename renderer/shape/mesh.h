#pragma once

#include <memory>

#include "renderer/shape/distance_grid.h"
#include "renderer/shape/shape.h"
#include "renderer/shape/triangle_mesh.h"

namespace translucube {

struct MeshGeometry;

/// A closed triangle mesh, intersected by Embree (embree_mesh.cpp).
class Mesh {
 public:
  explicit Mesh(std::shared_ptr<const MeshGeometry> geometry) : geometry_(std::move(geometry)) {}

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

 private:
  std::shared_ptr<const MeshGeometry> geometry_;
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
