#pragma once

#include <array>
#include <cstdint>

#include "renderer/shape/body/distance_field.h"
#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// The surface of a field within a box of cubic cells, with the field's own normals: by tetrahedra,
/// six to a cell along its diagonal (Kuhn 1960), each of which it leaves through whole triangles.
/// So it is closed and has no edge of more than two triangles, whatever the field, as long as it
/// stays within the box.
TriangleMesh isosurface(const DistanceField& field, Vec3 low, double cell,
                        const std::array<std::uint32_t, 3>& cells);

}  // namespace translucube
