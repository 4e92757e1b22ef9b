#pragma once

// A hollow bowl: half of a spherical shell with a flat rim.

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/shape/shape.h"

namespace translucube {

/// The shell between spheres of radius `inner` and 1 about the origin, where y < 0. Not convex:
/// light that leaves into the hollow enters again. Answers as shape.h says; from either side each
/// surface is met where a ray passes it in the right direction only, so that none is hit twice.
class Bowl {
 public:
  explicit Bowl(double inner) : inner_(inner) {}
  static constexpr bool convex() { return false; }

  bool inside(Vec3 p) const {
    const double r2 = length_squared(p);
    return p.y < 0 && r2 < 1 && r2 > inner_ * inner_;
  }
  double clearance(Vec3 p) const {
    const double r2 = length_squared(p);
    return std::min({0.5 * (1 - r2), (r2 - inner_ * inner_) / (1 + inner_), -p.y});
  }

  bool intersect_outside(Vec3 p, Vec3 d, Hit& hit) const {
    const double b = dot(p, d), nearest2 = length_squared(p - b * d);
    double t = infinity;
    Surface surface = Surface::rim;
    const auto try_at = [&](double candidate, Surface which) {
      if (candidate >= 0 && candidate < t) t = candidate, surface = which;
    };
    const auto below_rim = [&](double at) { return p.y + at * d.y < 0 ? at : infinity; };
    if (b < 0 && nearest2 < 1) try_at(below_rim(-b - std::sqrt(1 - nearest2)), Surface::outer);
    const double inner2 = inner_ * inner_;
    if (nearest2 < inner2) try_at(below_rim(-b + std::sqrt(inner2 - nearest2)), Surface::inner);
    if (d.y < 0) {
      const double at = -p.y / d.y, r2 = length_squared(p + at * d);
      if (r2 < 1 && r2 > inner2) try_at(at, Surface::rim);
    }
    if (t == infinity) return false;
    land(p, d, t, surface, hit);
    return true;
  }

  bool intersect_inside(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
    const double b = dot(p, d), r2 = length_squared(p), depth2 = std::fmax(0.0, 1 - r2);
    const double root = std::sqrt(b * b + depth2);
    double t = b > 0 ? depth2 / (b + root) : root - b;  // without cancellation on either side
    Surface surface = Surface::outer;
    const double above2 = std::fmax(0.0, r2 - inner_ * inner_), half2 = b * b - above2;
    if (b < 0 && half2 > 0) {
      const double at = above2 / (std::sqrt(half2) - b);
      if (at < t) t = at, surface = Surface::inner;
    }
    if (d.y > 0) {
      const double at = std::fmax(0.0, -p.y / d.y);
      if (at < t) t = at, surface = Surface::rim;
    }
    if (t >= t_max) return false;
    land(p, d, t, surface, hit);
    return true;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  enum class Surface { outer, inner, rim };

  void land(Vec3 p, Vec3 d, double t, Surface surface, Hit& hit) const {
    const Vec3 q = p + t * d;
    hit.t = t;
    if (surface == Surface::rim) {
      hit.p = {q.x, 0, q.z};
      hit.n = {0, 1, 0};
      return;
    }
    const Vec3 up = normalize(q);
    hit.p = surface == Surface::outer ? up : inner_ * up;
    hit.n = surface == Surface::outer ? up : -up;
  }

  double inner_;
};

}  // namespace translucube
