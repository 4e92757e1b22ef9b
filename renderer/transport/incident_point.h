#pragma once

// Samples the point of the surface where light came in that the dipole sends out elsewhere: in
// proportion to R_d of the distance, as far as the shape allows, without bias.

#include <cmath>
#include <limits>
#include <numbers>

#include "renderer/base/sampler.h"
#include "renderer/optics/dipole.h"
#include "renderer/shape/sphere.h"

namespace translucube {

struct IncidentPoint {
  Vec3 p, n;          ///< on the surface, its outward normal
  double r = 0;       ///< straight distance from the first point
  double weight = 0;  ///< R_d(r) of the clear body over the density of p per area; 0: there is none
  bool lost = false;  ///< a line met more surfaces than is believable and was cut short
};

/// On the unit sphere the area within a chord r is that of the flat disc (Archimedes): the radius
/// of the plane is the chord, and the density is R_d / mass exactly.
inline IncidentPoint sample_incident_point(const Sphere&, const DipoleRadii& dipole, Vec3, Vec3 n,
                                           Sample2 u, Rng&) {
  const double r = dipole.sample(u.u), phi = 2 * std::numbers::pi * u.v;
  const double sine = r * std::sqrt(std::fmax(0.0, 1 - r * r / 4)), cosine = 1 - r * r / 2;
  const Frame frame(n);
  const Vec3 p = normalize(frame.to_world({sine * std::cos(phi), sine * std::sin(phi), cosine}));
  return {p, p, r, dipole.mass(), false};
}

/// Any shape: a point of the disc about one of three axes, projected along it through the whole
/// body (King, Kulla, Conty, Fajardo 2013, "BSSRDF Importance Sampling"), the axes weighted by the
/// balance heuristic. R_d falls with r and a projection only shortens it, so that weights are
/// bounded. One of the points on the line stands for all (a reservoir of one, in proportion to
/// their weights).
template <class Shape>
IncidentPoint sample_incident_point(const Shape& shape, const DipoleRadii& dipole, Vec3 origin,
                                    Vec3 n, Sample2 u, Rng& rng) {
  constexpr int most_crossings = 1024;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double along_normal = 0.5, along_tangent = 0.25;
  const Frame frame(n);
  // The one fourth of u that picks the axis is stretched back to [0, 1).
  Vec3 axis = frame.z, x = frame.x, y = frame.y;
  double v = 2 * u.v;
  if (u.v >= 0.75) {
    axis = frame.y, x = frame.z, y = frame.x, v = 4 * u.v - 3;
  } else if (u.v >= 0.5) {
    axis = frame.x, x = frame.y, y = frame.z, v = 4 * u.v - 2;
  }
  const double radius = dipole.sample(u.u), phi = 2 * std::numbers::pi * v;
  const Vec3 on_disc = origin + radius * (std::cos(phi) * x + std::sin(phi) * y);

  const auto density_along = [&](Vec3 a, Vec3 from_origin, Vec3 normal) {
    const double projected = length(from_origin - dot(from_origin, a) * a);
    return dipole.reflectance(projected) / dipole.mass() * std::fabs(dot(normal, a));
  };
  IncidentPoint chosen;
  double total = 0;
  const auto offer = [&](const Hit& hit) {
    const Vec3 from_origin = hit.p - origin;
    const double density = along_normal * density_along(frame.z, from_origin, hit.n) +
                           along_tangent * density_along(frame.x, from_origin, hit.n) +
                           along_tangent * density_along(frame.y, from_origin, hit.n);
    const double r = length(from_origin);
    if (density <= 0 || r > dipole.reach()) return;
    const double weight = dipole.reflectance(r) / density;
    total += weight;
    if (rng.uniform() * total < weight) {
      chosen.p = hit.p;
      chosen.n = hit.n;
      chosen.r = r;
    }
  };
  // From outside of the bounding sphere, whatever the origin and the radius.
  Vec3 p = on_disc - 4.0 * axis;
  Hit hit;
  int crossings = 0;
  while (shape.intersect_outside(p, axis, hit)) {
    offer(hit);
    p = hit.p;
    if (!shape.intersect_inside(p, axis, infinity, hit)) break;
    offer(hit);
    p = hit.p;
    if (++crossings == most_crossings) {
      chosen.lost = true;
      break;
    }
  }
  chosen.weight = total;
  return chosen;
}

}  // namespace translucube
