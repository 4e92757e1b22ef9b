#pragma once

// A plane behind the body, patterned, or below it, the ground: infinite, facing +z or +y, and black
// to whoever looks from behind. It hides all of the environment that lies beyond.

#include <cmath>

#include "renderer/base/vec.h"

namespace translucube {

/// What a patterned plane behind the body is.
enum class BackdropKind {
  light_table,  ///< it shines by itself and reflects nothing
  print,        ///< it reflects as a Lambertian surface what falls on it
};
/// How the light and the dark parts lie.
enum class Pattern {
  plain,    ///< light everywhere
  checker,  ///< squares, half a period wide
  stripes,  ///< upright, half a period wide
  grid,     ///< dark lines, a tenth of a period wide
};
struct BackdropSpec {
  BackdropKind kind = BackdropKind::light_table;
  Pattern pattern = Pattern::checker;
  double distance_mm = 0;      ///< from the body's hindmost point (least z)
  double period_mm = 10;       ///< of the pattern, which is centred at x = y = 0
  double light = 1, dark = 0;  ///< white radiance, or reflectance in [0, 1]
  friend bool operator==(const BackdropSpec&, const BackdropSpec&) = default;
};

/// A plane in contact lies this far behind the body, in its unit: an air film without thickness
/// to the eye. There is no optical contact; the body's face stays one against air.
inline constexpr double contact_gap = 1e-6;

/// The plane as the transport meets it, in the body's coordinates.
struct Backdrop {
  BackdropKind kind = BackdropKind::light_table;
  Pattern pattern = Pattern::plain;
  double height = 0;                  ///< of its points along the normal
  double center_x = 0, center_y = 0;  ///< of the pattern
  double period = 1;
  float light = 1, dark = 0;  ///< radiance of a light table, reflectance of a print
  bool lies = false;          ///< it is the ground: its normal is +y, and its pattern plain

  Vec3 normal() const { return lies ? Vec3{0, 1, 0} : Vec3{0, 0, 1}; }
  /// Whether a ray along d comes to it.
  bool faces(Vec3 d) const { return (lies ? d.y : d.z) < 0; }
  /// Where such a ray meets it.
  Vec3 meet(Vec3 p, Vec3 d) const {
    if (lies) {
      const double t = (height - p.y) / d.y;
      return {p.x + t * d.x, height, p.z + t * d.z};
    }
    const double t = (height - p.z) / d.z;
    return {p.x + t * d.x, p.y + t * d.y, height};
  }

  /// The pattern at a point of the plane.
  float value(Vec3 p) const {
    const double x = (p.x - center_x) / period, y = (p.y - center_y) / period;
    const auto phase = [](double at) { return at - std::floor(at); };
    constexpr double line = 0.1;  // of the period
    bool bright = true;
    switch (pattern) {
      case Pattern::plain:
        break;
      case Pattern::checker:
        bright = (phase(x) < 0.5) == (phase(y) < 0.5);
        break;
      case Pattern::stripes:
        bright = phase(x) < 0.5;
        break;
      case Pattern::grid:
        bright = phase(x + line / 2) >= line && phase(y + line / 2) >= line;
        break;
    }
    return bright ? light : dark;
  }
};

}  // namespace translucube
