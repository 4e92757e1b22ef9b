#pragma once

// Convex bodies with flat faces: plates, boxes and wedges.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "renderer/shape/shape.h"

namespace translucube {

/// What lies behind all of its planes. Answers as shape.h says, in double precision: a ray inside
/// leaves by the nearest plane that it looks at from behind, so that no face is hit twice.
class Polytope {
 public:
  struct Plane {
    Vec3 n;             ///< outward, unit
    double offset = 0;  ///< dot(n, p) of its points
  };
  static constexpr std::size_t faces = 6;

  explicit Polytope(const std::array<Plane, faces>& planes) : planes_(planes) {}
  static constexpr bool convex() { return true; }

  bool inside(Vec3 p) const { return clearance(p) > 0; }
  double clearance(Vec3 p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Plane& plane : planes_) least = std::min(least, depth(plane, p));
    return least;
  }

  std::span<const Plane> planes() const { return planes_; }

  bool intersect_outside(Vec3 p, Vec3 d, Hit& hit) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double in = -infinity, out = infinity;
    const Plane* face = nullptr;
    for (const Plane& plane : planes_) {
      const double facing = dot(plane.n, d), room = depth(plane, p);
      if (facing < 0) {
        const double t = room / facing;
        if (t > in) in = t, face = &plane;
      } else if (facing > 0) {
        out = std::min(out, room / facing);
      } else if (room < 0) {
        return false;
      }
    }
    if (!(in >= 0) || in >= out) return false;
    land(p, d, in, *face, hit);
    return true;
  }

  bool intersect_inside(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
    double nearest = std::numeric_limits<double>::infinity();
    const Plane* face = nullptr;
    for (const Plane& plane : planes_) {
      const double facing = dot(plane.n, d);
      if (facing <= 0) continue;
      const double t = depth(plane, p) / facing;
      if (t < nearest) nearest = t, face = &plane;
    }
    if (face == nullptr || nearest >= t_max) return false;
    land(p, d, std::max(0.0, nearest), *face, hit);
    return true;
  }

 private:
  static double depth(const Plane& plane, Vec3 p) { return plane.offset - dot(plane.n, p); }
  void land(Vec3 p, Vec3 d, double t, const Plane& face, Hit& hit) const {
    const Vec3 q = p + t * d;
    hit = {q + depth(face, q) * face.n, face.n, t,
           static_cast<std::uint32_t>(&face - planes_.data())};
  }

  std::array<Plane, faces> planes_;
};

/// The box |x| < half.x, |y| < half.y, |z| < half.z.
inline Polytope make_box(Vec3 half) {
  return Polytope({{{{1, 0, 0}, half.x},
                    {{-1, 0, 0}, half.x},
                    {{0, 1, 0}, half.y},
                    {{0, -1, 0}, half.y},
                    {{0, 0, 1}, half.z},
                    {{0, 0, -1}, half.z}}});
}

/// Within that box: its back is flat, its front falls from half.z on the right (+x) to
/// thin - half.z on the left; thin in [0, 2 half.z].
inline Polytope make_wedge(Vec3 half, double thin) {
  const Vec3 front = normalize(Vec3{-(2 * half.z - thin), 0, 2 * half.x});
  return Polytope({{{{1, 0, 0}, half.x},
                    {{-1, 0, 0}, half.x},
                    {{0, 1, 0}, half.y},
                    {{0, -1, 0}, half.y},
                    {front, dot(front, {half.x, 0, half.z})},
                    {{0, 0, -1}, half.z}}});
}

}  // namespace translucube
