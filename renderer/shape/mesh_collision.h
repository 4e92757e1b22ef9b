#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// Two triangles of a mesh that meet, and about where.
struct Meeting {
  std::uint32_t first = 0, second = 0;
  Vec3 place;
};

/// One of the places where a mesh meets itself, if there is one: triangles of different parts that
/// touch, or triangles of one part that cross by more than what rounding makes of neighbours.
/// `part_of`: of each triangle. In time about proportional to the triangles, but where so many lie
/// in one place that most of them meet.
std::optional<Meeting> find_meeting(const TriangleMesh& mesh,
                                    std::span<const std::uint32_t> part_of);

}  // namespace translucube
