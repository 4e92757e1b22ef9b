#pragma once

#include <cmath>
#include <numbers>

#include "renderer/base/vec.h"

namespace translucube {

/// Pinhole with square pixels; `vfov_rad` spans the height of the image.
struct Camera {
  Vec3 position;
  Vec3 right, up, forward;  ///< orthonormal; right is towards rising x of the image
  double tan_half = 0.287;  ///< of half the vertical field of view
  int width = 1, height = 1;

  Camera() = default;
  /// `up_`: of any length, not along the view.
  Camera(Vec3 position_, Vec3 target, Vec3 up_, double vfov_deg, int width_, int height_)
      : position(position_), width(width_), height(height_) {
    forward = direction_of(target - position);
    right = direction_of(cross(forward, direction_of(up_)));
    up = cross(right, forward);
    tan_half = std::tan(vfov_deg * std::numbers::pi / 360);
  }

  /// Direction through (x, y) in pixels from the top left corner.
  Vec3 direction(double x, double y) const {
    const double scale = 2 * tan_half / height;
    return normalize(forward + (x - 0.5 * width) * scale * right - (y - 0.5 * height) * scale * up);
  }
};

}  // namespace translucube
