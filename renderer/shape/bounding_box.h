#pragma once

#include <algorithm>
#include <limits>

#include "renderer/base/vec.h"

namespace translucube {

/// Of points, along the axes.
struct BoundingBox {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};

  void add(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const BoundingBox& b) {
    add(b.low);
    add(b.high);
  }
  bool meets(const BoundingBox& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y &&
           low.z <= b.high.z && b.low.z <= high.z;
  }
  bool holds(const BoundingBox& b) const {
    return low.x <= b.low.x && b.high.x <= high.x && low.y <= b.low.y && b.high.y <= high.y &&
           low.z <= b.low.z && b.high.z <= high.z;
  }
  Vec3 center() const { return 0.5 * low + 0.5 * high; }
};

}  // namespace translucube
