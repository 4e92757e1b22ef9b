#pragma once

#include <cmath>

#include "renderer/shape/shape.h"

namespace translucube {

/// The infinite plate |z| < 1/2: the truths of slab optics are known for it.
struct Slab {
  static constexpr bool convex() { return true; }

  bool inside(Vec3 p) const { return std::fabs(p.z) < 0.5; }
  double clearance(Vec3 p) const { return 0.5 - std::fabs(p.z); }

  bool intersect_outside(Vec3 p, Vec3 d, Hit& hit) const {
    const double side = std::copysign(0.5, p.z);
    if (p.z * d.z >= 0) return false;
    hit.t = (side - p.z) / d.z;
    if (hit.t < 0) return false;
    land(p, d, side, hit);
    return true;
  }

  bool intersect_inside(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
    if (std::fabs(p.z + t_max * d.z) < 0.5) return false;
    if (d.z == 0) return false;  // along the plate for ever
    const double side = std::copysign(0.5, d.z);
    hit.t = std::fmax(0.0, (side - p.z) / d.z);
    land(p, d, side, hit);
    return true;
  }

 private:
  static void land(Vec3 p, Vec3 d, double side, Hit& hit) {
    hit.p = p + hit.t * d;
    hit.p.z = side;
    hit.n = {0, 0, std::copysign(1.0, side)};
  }
};

}  // namespace translucube
