#pragma once

// The normals at the corners of a mesh's triangles: those of its file, or means of the triangles
// around a vertex.

#include <array>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// Outward, unit; zero where a triangle without area leaves none.
using CornerNormals = std::array<Vec3, 3>;

/// What the mesh says of a triangle's corners, turned to the side of its front. A normal that
/// stands askew to the triangle by more than 75 degrees, or that is not there, is the triangle's
/// own.
CornerNormals corner_normals(const TriangleMesh& mesh, std::size_t triangle);

/// Whether it has normals that say something: some differ by more than half a degree from those of
/// their triangles.
bool has_smooth_normals(const TriangleMesh& mesh);

/// Gives each vertex one normal, the mean of its triangles' weighted so that it is exact where the
/// neighbours lie on a sphere with the vertex (Max 1999).
void average_normals(TriangleMesh& mesh);

}  // namespace translucube
