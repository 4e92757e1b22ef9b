#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "renderer/base/vec.h"

namespace translucube {

struct MeshError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles with shared vertices, counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  /// What a file says of the surface that the triangles stand for (smooth.h): unit, of either sign.
  std::vector<Vec3> normals = {};
  std::vector<Triangle> corner_normals = {};  ///< of each triangle into them; empty: there are none
};
/// Of a corner: its normal is that of its triangle.
inline constexpr std::uint32_t no_normal = std::numeric_limits<std::uint32_t>::max();

/// What became of a mesh that was closed.
struct MeshReport {
  std::uint64_t vertices = 0, triangles = 0;  ///< of the boundary
  std::uint64_t welded_vertices = 0;          ///< of those that were equal to others, all but one
  std::uint64_t dropped_triangles = 0;        ///< those with two corners in one place
  std::uint64_t parts = 0;                    ///< closed ones, before they were one body
  friend bool operator==(const MeshReport&, const MeshReport&) = default;
};

/// Merges equal vertices, drops triangles with two corners in one place, and unites the parts to
/// the boundary of one body, seen from outside (mesh_parts.h). Vertices that are not of it go.
/// Throws MeshError if it is empty, not finite, or not closed: every edge must be shared by two
/// triangles that run along it in opposite directions, and no two of them may cross.
MeshReport close_mesh(TriangleMesh& mesh);

/// A mesh as it was read, and what was done to close it.
struct ClosedMesh {
  TriangleMesh mesh;
  MeshReport report;
};

/// Signed volume (divergence theorem); > 0 if the normals point outward.
double volume(const TriangleMesh& mesh);
double surface_area(const TriangleMesh& mesh);
/// Whether a closed mesh bounds one convex body; false in doubt.
bool is_convex(const TriangleMesh& mesh);

}  // namespace translucube
