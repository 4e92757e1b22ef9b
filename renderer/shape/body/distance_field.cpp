#include "renderer/shape/body/distance_field.h"

#include <limits>
#include <numeric>

namespace translucube {
namespace {

Distance to_ball(Vec3 center, double radius, Vec3 p) {
  const Vec3 from = p - center;
  const double far = length(from);
  return {far - radius, far > 0 ? from * (1 / far) : Vec3{}};
}

/// The weights of the point of a triangle that is nearest to p (Ericson 2005, section 5.1.5).
Vec3 nearest_weights(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double all = 1 / (va + vb + vc);
  return {va * all, vb * all, vc * all};
}

/// Smooth minimum by a polynomial of the second degree (Quilez 2013).
Distance melt(const Distance& a, const Distance& b, double width) {
  const double apart = a.value - b.value;
  if (apart >= width) return b;
  if (apart <= -width) return a;
  const double share = 0.5 - 0.5 * apart / width, h = (width - std::fabs(apart)) / width;
  return {std::min(a.value, b.value) - 0.25 * h * h * width,
          share * a.gradient + (1 - share) * b.gradient};
}

}  // namespace

Distance distance_to(const RoundCone& cone, Vec3 p) {
  const Vec3 axis = cone.b - cone.a, from = p - cone.a;
  const double whole = length(axis), fall = cone.a_radius - cone.b_radius;
  if (whole <= std::fabs(fall))
    return fall > 0 ? to_ball(cone.a, cone.a_radius, p) : to_ball(cone.b, cone.b_radius, p);
  const Vec3 w = axis * (1 / whole);
  const double along = dot(from, w);
  const Vec3 off = from - along * w;
  const double r = length(off), sine = fall / whole, cosine = std::sqrt(1 - sine * sine);
  // Where the normal of the cone's side through p meets the axis.
  const double foot = along - r * sine / cosine;
  if (foot <= 0) return to_ball(cone.a, cone.a_radius, p);
  if (foot >= whole) return to_ball(cone.b, cone.b_radius, p);
  const Vec3 outward = r > 0 ? off * (1 / r) : Vec3{};
  return {r * cosine + along * sine - cone.a_radius, cosine * outward + sine * w};
}

Distance distance_to(const RoundPlate& plate, Vec3 p) {
  const Vec3 weights = nearest_weights(plate.a, plate.b, plate.c, p);
  const Vec3 nearest = weights.x * plate.a + weights.y * plate.b + weights.z * plate.c;
  const double radius =
      weights.x * plate.a_radius + weights.y * plate.b_radius + weights.z * plate.c_radius;
  return to_ball(nearest, radius, p);
}

void DistanceField::add(const RoundCone& cone, double width) {
  parts_.push_back({false, static_cast<std::uint32_t>(cones_.size()), width});
  cones_.push_back(cone);
}

void DistanceField::add(const RoundPlate& plate, double width) {
  parts_.push_back({true, static_cast<std::uint32_t>(plates_.size()), width});
  plates_.push_back(plate);
}

DistanceField::Selection DistanceField::all() const {
  Selection parts(parts_.size());
  std::iota(parts.begin(), parts.end(), 0u);
  return parts;
}

DistanceField::Selection DistanceField::near(Vec3 center, double radius,
                                             std::span<const std::uint32_t> parts) const {
  std::vector<double> values;
  values.reserve(parts.size());
  for (const std::uint32_t i : parts) values.push_back(distance(parts_[i], center).value);
  // The nearest one is at most so far anywhere in the ball; what is farther by more than its width
  // counts nowhere there, or next to nothing.
  const double reach = std::ranges::min(values) + 2 * radius;
  Selection nearer;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (values[i] <= reach + 1.5 * parts_[parts[i]].width) nearer.push_back(parts[i]);
  return nearer;
}

Distance DistanceField::at(Vec3 p, std::span<const std::uint32_t> parts) const {
  Distance sum{std::numeric_limits<double>::infinity(), {}};
  for (const std::uint32_t i : parts) {
    const Distance next = distance(parts_[i], p);
    sum = std::isinf(sum.value) ? next : melt(sum, next, parts_[i].width);
  }
  return sum;
}

}  // namespace translucube
