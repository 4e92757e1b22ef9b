#pragma once

#include <cmath>

#include "renderer/shape/shape.h"

namespace translucube {

/// Everything below z = 0: what a surface looks like to a walk of vanishing mean free path.
struct HalfSpace {
  double clearance(Vec3 p) const { return -p.z; }

  bool intersect_inside(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
    if (p.z + t_max * d.z < 0) return false;
    hit = {{}, {0, 0, 1}, -p.z / d.z};
    return true;
  }
};

}  // namespace translucube
