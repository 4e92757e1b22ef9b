#pragma once

// A flat slab between two equal faces, what falls on it, and where its light leaves. The slab knows
// one coordinate only: the depth z across it, in units of its thickness, and mu = the cosine of the
// direction of travel with +z; interfaces and scatterers are isotropic about z, so no azimuth is
// carried.

#include <array>
#include <cmath>
#include <numbers>

#include "renderer/optics/interface.h"
#include "renderer/optics/interior.h"

namespace translucube::slab {

enum class Incidence { normal, diffuse };  ///< collimated along +z, or Lambertian on the face z = 0
inline constexpr std::array incidences{Incidence::normal, Incidence::diffuse};

/// Where light leaves. Beside reflection: the angle from the direction of normal incidence, which
/// haze and clarity ask for; diffuse incidence has no such direction, all its light is `wide`.
enum class Exit { reflected, core, ring, wide };
inline constexpr int exit_count = 4;
/// Half angles of the cones around the incident direction: core < ring < wide [degrees].
inline constexpr double core_half_angle_deg = 0.5, ring_half_angle_deg = 2.5;

inline double sin2_of_degrees(double degrees) {
  const double sine = std::sin(degrees * std::numbers::pi / 180);
  return sine * sine;
}
inline const double core_sin2 = sin2_of_degrees(core_half_angle_deg);
inline const double ring_sin2 = sin2_of_degrees(ring_half_angle_deg);
/// The cone of light whose angle from the normal, outside, has this sine, squared.
inline Exit cone_of(double sin2) {
  if (!(sin2 < ring_sin2)) return Exit::wide;
  return sin2 < core_sin2 ? Exit::core : Exit::ring;
}

/// A slab of thickness 1.
struct Body {
  AnyInterface interface;  ///< the same on both faces
  AnyInterior interior;
  double least_sigma_a = 0;  ///< of all channels [1 / thickness]: may end paths that none sees
};

}  // namespace translucube::slab
