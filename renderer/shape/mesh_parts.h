#pragma once

// A mesh file may hold several closed parts: beside each other, in each other, inside out.

#include <cstddef>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// Makes the closed parts of a mesh the boundary of one body, its normals outward. A part that lies
/// in no other bounds a body however it is oriented; parts within it count by the winding number
/// (non-zero is inside): one that is oriented the same way lies in the body and goes, one that is
/// oriented the other way is a cavity. Returns how many there were. Throws MeshError that says
/// where the surface crosses itself, or which two parts meet. The edges must be closed already.
std::size_t unite_parts(TriangleMesh& mesh);

}  // namespace translucube
