#pragma once

#include <cmath>

#include "renderer/shape/shape.h"

namespace translucube {

/// The unit sphere. It also rolls: every chord of a ray that is totally reflected inside is the
/// same, so the light that is trapped in a thin medium needs no loop over its reflections.
struct Sphere {
  static constexpr bool convex() { return true; }

  /// Moves a ray that starts at the surface (p unit) inward along d by a distance, reflected
  /// wherever it meets the surface.
  static void roll(Vec3& p, Vec3& d, double distance) {
    const double cosine = std::fmax(-dot(p, d), 1e-150);
    const Vec3 along = d + cosine * p;
    const double sine = length(along);
    if (sine == 0) return;  // back and forth through the centre: never totally reflected
    const Vec3 n = p, t = along * (1 / sine);
    const double chord = 2 * cosine, chords = std::floor(distance / chord);
    const double angle = chords * 2 * std::atan2(cosine, sine);
    p = std::cos(angle) * n + std::sin(angle) * t;
    d = sine * (std::cos(angle) * t - std::sin(angle) * n) - cosine * p;
    p = p + (distance - chords * chord) * d;
  }

  bool inside(Vec3 p) const { return length_squared(p) < 1; }
  double clearance(Vec3 p) const { return 0.5 * (1 - length_squared(p)); }

  bool intersect_outside(Vec3 p, Vec3 d, Hit& hit) const {
    const double b = dot(p, d);
    const Vec3 nearest = p - b * d;
    const double half_chord2 = 1 - length_squared(nearest);
    if (b >= 0 || half_chord2 <= 0) return false;
    const double t = -b - std::sqrt(half_chord2);
    if (t < 0) return false;
    hit.n = normalize(p + t * d);
    hit.p = hit.n;
    hit.t = t;
    return true;
  }

  bool intersect_inside(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
    if (length_squared(p + t_max * d) < 1) return false;
    const double b = dot(p, d), depth2 = std::fmax(0.0, 1 - length_squared(p));
    const double root = std::sqrt(b * b + depth2);
    hit.t = b > 0 ? depth2 / (b + root) : root - b;  // without cancellation on either side
    hit.n = normalize(p + hit.t * d);
    hit.p = hit.n;
    return true;
  }
};

}  // namespace translucube
