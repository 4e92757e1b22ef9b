#include <algorithm>

#include "renderer/shape/body/body.h"
#include "renderer/shape/body/octants.h"

namespace translucube {

BodyMesh make_rounded_box(Vec3 extents, double edge) {
  constexpr std::uint32_t parts = 12;  // of a right angle: curved triangles are a millionth off
  const Vec3 half = 0.5 * extents;
  const auto inner = [&](double h) { return std::max(0.0, h - edge); };
  BodyMesh body{Octants(parts).rounded_box({inner(half.x), inner(half.y), inner(half.z)}, edge),
                std::min({extents.x, extents.y, extents.z})};
  close_mesh(body.mesh);
  return body;
}

}  // namespace translucube
