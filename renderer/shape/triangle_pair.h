#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/vec.h"

namespace translucube {

using Corners = std::array<Vec3, 3>;

/// Two triangles, told apart by separating axes (Gottschalk 1996): both normals, the nine products
/// of edges, and, for triangles in a common plane or without area, the edges and what is
/// perpendicular to them.
class TrianglePair {
 public:
  TrianglePair(const Corners& a, const Corners& b) {
    for (std::size_t i = 0; i < 3; ++i) {
      a_[i] = a[i] - a[0];
      b_[i] = b[i] - a[0];
      for (const Vec3& p : {a_[i], b_[i]}) size_ = std::max(size_, sum_of_sizes(p));
    }
  }

  bool touch() const {
    return !any_axis([this](Vec3 axis) { return gap(axis) > 0; });
  }
  /// By more than rounding: neighbours, which share a corner or a side, do not.
  bool cross() const {
    constexpr double rounding = 1e-12;
    return !any_axis(
        [this](Vec3 axis) { return gap(axis) >= -rounding * size_ * sum_of_sizes(axis); });
  }

 private:
  static double sum_of_sizes(Vec3 v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); }

  /// Between their shadows on the axis; less than 0 where these overlap.
  double gap(Vec3 axis) const {
    const auto [a_low, a_high] =
        std::minmax({dot(a_[0], axis), dot(a_[1], axis), dot(a_[2], axis)});
    const auto [b_low, b_high] =
        std::minmax({dot(b_[0], axis), dot(b_[1], axis), dot(b_[2], axis)});
    return std::max(b_low - a_high, a_low - b_high);
  }

  template <class Separates>
  bool any_axis(Separates separates) const {
    const auto apart = [&](Vec3 axis) { return length_squared(axis) > 0 && separates(axis); };
    const Corners e{a_[1] - a_[0], a_[2] - a_[1], a_[0] - a_[2]},
        f{b_[1] - b_[0], b_[2] - b_[1], b_[0] - b_[2]};
    const Vec3 n = translucube::cross(e[0], e[1]), m = translucube::cross(f[0], f[1]);
    if (apart(n) || apart(m)) return true;
    for (const Vec3& x : e)
      for (const Vec3& y : f)
        if (apart(translucube::cross(x, y))) return true;
    for (const Corners& sides : {e, f})
      for (const Vec3& x : sides)
        if (apart(translucube::cross(n, x)) || apart(translucube::cross(m, x)) || apart(x))
          return true;
    return false;
  }

  Corners a_, b_;
  double size_ = 0;
};

}  // namespace translucube
