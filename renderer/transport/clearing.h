#pragma once

// What a walk inside a mesh knows of the space around it. Most flights end, and most large steps
// fit, within a distance that is known to be free, and need no ray: a table bounds it (Mesh::
// distance_bounds), and where the table is too coarse a query for the nearest face leaves a ball
// that serves until the walk is out of it.

#include "renderer/optics/ball_tables.h"
#include "renderer/optics/medium.h"
#include "renderer/shape/mesh.h"

namespace translucube {

class Clearing {
 public:
  Clearing(const Mesh& mesh, const Medium& medium) : mesh_(mesh), medium_(medium) {}

  bool intersect_inside(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
    if (in_ball(p) && in_ball(p + t_max * d)) return false;
    if (t_max < mesh_.distance_bounds(p).least) return false;
    return mesh_.intersect_inside(p, d, t_max, hit);
  }

  /// A lower bound of the distance to the surface, good enough to choose a large step by.
  double clearance(Vec3 p) {
    const double way = length(p - center_);
    DistanceBounds room{free_.least - way, free_.most + way};
    if (settles(room)) return room.least;
    room = both(room, mesh_.distance_bounds(p));
    if (!settles(room)) room = both(room, mesh_.finer_distance_bounds(p));
    if (!settles(room)) room = both(room, mesh_.distance(p, room.most));
    center_ = p;
    free_ = {std::fmax(0.0, room.least - rounding), room.most};
    return free_.least;
  }

 private:
  /// The smallest large step [mean free paths].
  static constexpr double smallest = 2;
  /// How much larger than the known one a step may have to be for a query to pay; by CPU time
  /// (tests/bench/speed/meshes.cpp).
  static constexpr double worth_a_query = 8;
  /// In units of the body: what adding up a position may lose in double precision, a thousandfold.
  static constexpr double rounding = 1e-12;

  bool in_ball(Vec3 p) const { return length_squared(p - center_) < free_.least * free_.least; }

  static DistanceBounds both(DistanceBounds a, DistanceBounds b) {
    return {std::fmax(a.least, b.least), std::fmin(a.most, b.most)};
  }

  /// Whether to know more would not pay: no large step is possible, or one nearly as large as any.
  bool settles(DistanceBounds room) const {
    return room.most * medium_.sigma_s < smallest || room.least * worth_a_query > room.most;
  }

  const Mesh& mesh_;
  const Medium& medium_;
  Vec3 center_{1e9, 0, 0};  ///< far from any body: nothing is known yet
  DistanceBounds free_;     ///< there
};

/// The shape as a walk asks it.
template <class Shape>
const Shape& surroundings(const Shape& shape, const Medium&) {
  return shape;
}
inline Clearing surroundings(const Mesh& mesh, const Medium& medium) { return {mesh, medium}; }

}  // namespace translucube
