#include "renderer/shape/file/gltf/placement.h"

#include <array>
#include <cmath>

namespace translucube::gltf {
namespace {

template <std::size_t n>
std::array<double, n> numbers(const Value& array) {
  if (array.size() != n) array.fail("must be " + std::to_string(n) + " numbers");
  std::array<double, n> values{};
  for (std::size_t i = 0; i < n; ++i) values[i] = array.at(i).number();
  return values;
}

Placement of_matrix(const Value& matrix) {
  const auto m = numbers<16>(matrix);  // by columns
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    matrix.fail("must have the last row 0 0 0 1");
  return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

/// The axes turned by a unit quaternion (x, y, z, w).
Placement of_rotation(const Value& rotation) {
  auto q = numbers<4>(rotation);
  const double size = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  // Single precision in a text of few digits.
  constexpr double rounding = 1e-3;
  if (std::fabs(size - 1) > rounding) rotation.fail("must be a unit quaternion");
  for (double& c : q) c /= size;
  const auto [x, y, z, w] = q;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
          {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
          {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
          {}};
}

}  // namespace

Placement placement_of(const Value& node) {
  const auto translation = node.find("translation"), rotation = node.find("rotation"),
             scale = node.find("scale");
  if (const auto matrix = node.find("matrix")) {
    if (translation || rotation || scale)
      node.fail("has a matrix beside translation, rotation or scale");
    return of_matrix(*matrix);
  }
  Placement placement = rotation ? of_rotation(*rotation) : Placement{};
  if (scale) {
    const auto [x, y, z] = numbers<3>(*scale);
    placement.x = x * placement.x;
    placement.y = y * placement.y;
    placement.z = z * placement.z;
  }
  if (translation) {
    const auto [x, y, z] = numbers<3>(*translation);
    placement.origin = {x, y, z};
  }
  return placement;
}

}  // namespace translucube::gltf
