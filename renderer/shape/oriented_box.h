#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "renderer/base/vec.h"
#include "renderer/shape/bounding_box.h"
#include "renderer/shape/triangle_pair.h"

namespace translucube {

/// A box about neighbouring triangles that lies as they do: along their long sides and their mean
/// normal, so that long and narrow ones have narrow boxes (Gottschalk 1996).
class OrientedBox {
 public:
  /// Nothing where they have no mean normal.
  static std::optional<OrientedBox> around(std::span<const Corners> triangles) {
    Vec3 normal, along;
    for (const Corners& t : triangles) {
      const Corners sides{t[1] - t[0], t[2] - t[1], t[0] - t[2]};
      normal = normal + cross(sides[0], sides[1]);
      const Vec3 side = std::ranges::max(sides, {}, [](Vec3 s) { return length_squared(s); });
      along = along + (dot(along, side) < 0 ? -side : side);
    }
    if (length_squared(normal) == 0) return std::nullopt;
    const Vec3 z = direction_of(normal), flat = along - dot(along, z) * z;
    const Vec3 x = length_squared(flat) == 0 ? Frame(z).x : direction_of(flat);
    return OrientedBox({x, cross(z, x), z}, triangles);
  }

  /// True only where they are; by their own six directions.
  bool apart(const OrientedBox& other) const {
    const Vec3 between = other.center_ - center_;
    const auto apart_along = [&](Vec3 axis) {
      double reach = 0;
      for (const OrientedBox* box : {this, &other})
        for (const Vec3& half : box->halves_) reach += std::fabs(dot(half, axis));
      constexpr double rounding = 1e-9;
      return std::fabs(dot(between, axis)) > reach + rounding * (size_ + other.size_);
    };
    return std::ranges::any_of(axes_, apart_along) || std::ranges::any_of(other.axes_, apart_along);
  }

 private:
  OrientedBox(const std::array<Vec3, 3>& axes, std::span<const Corners> triangles) : axes_(axes) {
    const Vec3 origin = triangles.front()[0];
    BoundingBox box;
    for (const Corners& t : triangles)
      for (const Vec3& p : t) {
        const Vec3 q = p - origin;
        box.add(Vec3{dot(q, axes[0]), dot(q, axes[1]), dot(q, axes[2])});
      }
    const Vec3 middle = box.center(), half = 0.5 * (box.high - box.low);
    center_ = origin + middle.x * axes[0] + middle.y * axes[1] + middle.z * axes[2];
    halves_ = {half.x * axes[0], half.y * axes[1], half.z * axes[2]};
    size_ = half.x + half.y + half.z + std::fabs(center_.x) + std::fabs(center_.y) +
            std::fabs(center_.z);
  }

  std::array<Vec3, 3> axes_, halves_;  ///< unit, and as long as the box is from its middle
  Vec3 center_;
  double size_ = 0;  ///< of what was rounded
};

}  // namespace translucube
