#pragma once

// Curved PN triangles: cubic Bezier triangles over flat ones (Vlachos, Peters, Boyd, Mitchell
// 2001).

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/vec.h"

namespace translucube {

/// The control point next to `from` of the curve to `to`, between two surfaces with these normals
/// there: in their common tangent plane, or along the crease where they differ. Its distance is
/// that of a circle's arc rather than a third of the chord's: on a sphere of 320 triangles the
/// error is a sixth of it then (tests/renderer/refine_test.cpp).
inline Vec3 control_point(Vec3 from, Vec3 to, Vec3 n, Vec3 m) {
  constexpr double crease = 0.05;  // sine of the angle between the normals: 3 degrees
  const Vec3 chord = to - from, across = cross(n, m);
  const double sine = length(across);
  Vec3 tangent = chord;
  if (sine > crease) {
    const Vec3 along = across * (1 / sine);
    tangent = dot(chord, along) * along;
  } else if (dot(n, m) > 0) {
    const Vec3 mean = normalize(n + m);
    tangent = chord - dot(chord, mean) * mean;
  }
  const double size = length(chord);
  if (size == 0) return from;
  const double cosine = std::max(length(tangent) / size, 0.5);
  return from + tangent * ((2.0 / 3) / (cosine * (1 + cosine)));
}

/// The curve of an edge.
struct Curve {
  std::array<Vec3, 4> points;  ///< controls

  Vec3 at(double t) const {
    const double s = 1 - t;
    return s * s * s * points[0] + 3 * s * s * t * points[1] + 3 * s * t * t * points[2] +
           t * t * t * points[3];
  }
  Curve reversed() const { return {{points[3], points[2], points[1], points[0]}}; }
  /// The mean of its second derivative. That of half the curve is a quarter of it.
  Vec3 bend() const { return 3 * (second(0) + second(1)); }
  /// A bound of its second derivative's length.
  double most_bend() const { return 6 * std::max(length(second(0)), length(second(1))); }

 private:
  Vec3 second(int i) const { return points[i] - 2 * points[i + 1] + points[i + 2]; }
};

/// The patch between three curves, each from a corner to the next.
class Patch {
 public:
  explicit Patch(const std::array<Curve, 3>& sides) : sides_(sides) {
    Vec3 corners, controls;
    for (const Curve& side : sides) {
      corners = corners + side.points[0];
      controls = controls + side.points[1] + side.points[2];
    }
    middle_ = controls * (1.0 / 4) - corners * (1.0 / 6);
  }

  /// At barycentric coordinates.
  Vec3 at(double u, double v, double w) const {
    const auto& [a, b, c] = sides_;
    return u * u * u * a.points[0] + v * v * v * b.points[0] + w * w * w * c.points[0] +
           3 * (u * u * v * a.points[1] + u * v * v * a.points[2] + v * v * w * b.points[1] +
                v * w * w * b.points[2] + w * w * u * c.points[1] + w * u * u * c.points[2]) +
           6 * u * v * w * middle_;
  }

 private:
  std::array<Curve, 3> sides_;
  Vec3 middle_;
};

}  // namespace translucube
