#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
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
};

/// Reads an OBJ or PLY file (assimp). Throws MeshError if it cannot be read or has no triangle.
TriangleMesh read_mesh(const std::filesystem::path& file);

/// Merges equal vertices, drops triangles without area, and turns the mesh outside out if its
/// volume is negative. Throws MeshError if it is empty, not finite, or not closed: every edge must
/// be shared by two triangles that run along it in opposite directions.
void close_mesh(TriangleMesh& mesh);

/// Signed volume (divergence theorem); > 0 if the normals point outward.
double volume(const TriangleMesh& mesh);
double surface_area(const TriangleMesh& mesh);
/// Whether a closed mesh bounds one convex body; false in doubt.
bool is_convex(const TriangleMesh& mesh);

}  // namespace translucube
