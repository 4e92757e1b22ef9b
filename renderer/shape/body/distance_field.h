#pragma once

// Bodies by their distance: rounded cones and plates that melt into each other.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/vec.h"

namespace translucube {

/// A distance to a surface, negative inside, and how it changes with the place.
struct Distance {
  double value;
  Vec3 gradient;
};

/// The hull of two balls.
struct RoundCone {
  Vec3 a, b;
  double a_radius, b_radius;
};

/// A triangle, as thick as a ball that rolls on it; the ball's radius goes from corner to corner.
struct RoundPlate {
  Vec3 a, b, c;
  double a_radius, b_radius, c_radius;
};

Distance distance_to(const RoundCone& cone, Vec3 p);
Distance distance_to(const RoundPlate& plate, Vec3 p);

/// The union of parts, each of which melts into those before it over a width of its own. Of two
/// that are more than a width apart in distance only the nearer counts.
class DistanceField {
 public:
  void add(const RoundCone& cone, double width);
  void add(const RoundPlate& plate, double width);

  /// Those of some parts that a place in a ball may see.
  using Selection = std::vector<std::uint32_t>;
  Selection all() const;
  Selection near(Vec3 center, double radius, std::span<const std::uint32_t> parts) const;

  Distance at(Vec3 p, std::span<const std::uint32_t> parts) const;

 private:
  struct Part {
    bool plate;
    std::uint32_t index;
    double width;
  };
  Distance distance(const Part& part, Vec3 p) const {
    return part.plate ? distance_to(plates_[part.index], p) : distance_to(cones_[part.index], p);
  }

  std::vector<RoundCone> cones_;
  std::vector<RoundPlate> plates_;
  std::vector<Part> parts_;
};

}  // namespace translucube
