#pragma once

// The shape of the body enters the transport through a few questions only. Lengths are in the
// body's own unit (sphere: its radius; slab: its thickness; mesh: its bounding radius), centred at
// the origin.

#include <cmath>
#include <memory>

#include "renderer/distance_grid.h"
#include "renderer/vec.h"

namespace translucube {

struct Hit {
  Vec3 p;        ///< on the surface
  Vec3 n;        ///< outward unit normal
  double t = 0;  ///< distance travelled
};

/// Every shape answers:
///   enter(p, d, hit)          first hit of a ray outside, towards the surface's front
///   exit(p, d, t_max, hit)    the hit of a ray inside if it is nearer than t_max
///   inside(p)                 whether a point lies in the body
///   clearance(p)              a lower bound of the distance of a point inside to the surface;
///                             for a mesh, the walk's clearing.h keeps it
///   convex()                  whether a ray that leaves can never come back

///
/// A sphere also rolls: every chord of a ray that is totally reflected inside is the same, so the
/// light that is trapped in a thin medium needs no loop over its reflections.

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

  bool enter(Vec3 p, Vec3 d, Hit& hit) const {
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

  bool exit(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
    if (length_squared(p + t_max * d) < 1) return false;
    const double b = dot(p, d), depth2 = std::fmax(0.0, 1 - length_squared(p));
    const double root = std::sqrt(b * b + depth2);
    hit.t = b > 0 ? depth2 / (b + root) : root - b;  // without cancellation on either side
    hit.n = normalize(p + hit.t * d);
    hit.p = hit.n;
    return true;
  }
};

/// The infinite plate |z| < 1/2: the truths of slab optics are known for it.
struct Slab {
  static constexpr bool convex() { return true; }

  bool inside(Vec3 p) const { return std::fabs(p.z) < 0.5; }
  double clearance(Vec3 p) const { return 0.5 - std::fabs(p.z); }

  bool enter(Vec3 p, Vec3 d, Hit& hit) const {
    const double side = std::copysign(0.5, p.z);
    if (p.z * d.z >= 0) return false;
    hit.t = (side - p.z) / d.z;
    if (hit.t < 0) return false;
    land(p, d, side, hit);
    return true;
  }

  bool exit(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
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

/// Everything below z = 0: what a surface looks like to a walk of vanishing mean free path.
struct HalfSpace {
  double clearance(Vec3 p) const { return -p.z; }

  bool exit(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
    if (p.z + t_max * d.z < 0) return false;
    hit = {{}, {0, 0, 1}, -p.z / d.z};
    return true;
  }
};

struct MeshGeometry;

/// A closed triangle mesh, intersected by Embree (intersect.cpp).
class Mesh {
 public:
  explicit Mesh(std::shared_ptr<const MeshGeometry> geometry) : geometry_(std::move(geometry)) {}

  bool convex() const;
  bool inside(Vec3 p) const;
  double clearance(Vec3 p) const { return distance_bounds(p).least; }
  /// Bounds of the distance to the surface, at the cost of a look at a table; a finer one takes its
  /// samples more often.
  DistanceBounds distance_bounds(Vec3 p) const;
  DistanceBounds finer_distance_bounds(Vec3 p) const;
  /// Closer bounds, where the distance is known to be at most `most`, at the cost of some rays.
  DistanceBounds distance(Vec3 p, double most) const;
  bool enter(Vec3 p, Vec3 d, Hit& hit) const;
  bool exit(Vec3 p, Vec3 d, double t_max, Hit& hit) const;

 private:
  std::shared_ptr<const MeshGeometry> geometry_;
};

}  // namespace translucube
