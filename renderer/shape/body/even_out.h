#pragma once

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// Gives a closed mesh whose vertices have one normal each better triangles, of the vertices that
/// it has: the ends of edges that are shorter than a length are drawn together where the mesh stays
/// a closed manifold (Dey, Edelsbrunner, Guha, Nekhayev 1999: the ends have two neighbours in
/// common), and edges are turned to the other diagonal of their two triangles where that makes
/// these less slender (Lawson 1977). No triangle turns away from the normals of its vertices,
/// and none crosses another: around a place where that would happen all stays as it is.
void even_out(TriangleMesh& mesh, double length);

}  // namespace translucube
