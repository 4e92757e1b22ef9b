#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "renderer/shape/smooth/lattice.h"
#include "renderer/shape/smooth/patch.h"

namespace translucube {

/// By how many chords a curve of this second derivative is met within an error (Wang 1984).
inline std::uint32_t parts_of(double bend, double error) {
  constexpr double most = 4096;
  return static_cast<std::uint32_t>(
      std::fmin(std::fmax(1.0, std::ceil(std::sqrt(bend / (8 * error)))), most));
}

/// A triangle that is to be divided, by the parts and the second derivatives of its sides.
struct Division {
  Three<std::uint32_t> parts;
  Three<Vec3> bends;

  std::uint32_t longest() const {
    return static_cast<std::uint32_t>(std::ranges::max_element(parts) - parts.begin());
  }
  bool whole() const { return parts[longest()] == 1; }
  /// Nearly as many on all sides: a lattice serves it.
  bool even() const {
    return parts[longest()] > 2 && parts[longest()] <= 2 * std::ranges::min(parts);
  }
  /// The side that is whole, where the other two are divided alike: a strip of triangles between
  /// these serves it; 3 where there is none. What is neither even nor a strip is cut in two.
  std::uint32_t strip() const {
    const auto whole = static_cast<std::uint32_t>(std::ranges::min_element(parts) - parts.begin());
    const std::uint32_t a = parts[next_corner(whole)], b = parts[next_corner(next_corner(whole))];
    return parts[whole] == 1 && std::max(a, b) <= 2 * std::min(a, b) ? whole : 3;
  }

  /// From the middle of a side to the opposite corner, as in a quadratic surface.
  Vec3 median(std::uint32_t side) const {
    return 0.25 *
           (2 * bends[next_corner(side)] + 2 * bends[next_corner(next_corner(side))] - bends[side]);
  }

  std::uint32_t parts_across(std::uint32_t side, double error) const {
    return parts[side] == 2 ? 1 : parts_of(length(median(side)), error);
  }

  std::uint64_t triangles(double error) const {
    if (whole()) return 1;
    if (strip() < 3) return parts[0] + parts[1] + parts[2] - 2;
    if (even()) {
      const std::uint64_t inner = parts[longest()] - 3;
      return parts[0] + parts[1] + parts[2] + 3 * inner + inner * inner;
    }
    const std::uint32_t k = longest(), l = next_corner(k), m = next_corner(l);
    const Vec3 median = this->median(k), half = 0.25 * bends[k];
    const std::uint32_t across = parts_across(k, error), first = parts[k] / 2;
    return Division{{first, across, parts[m]}, {half, median, bends[m]}}.triangles(error) +
           Division{{parts[k] - first, parts[l], across}, {half, bends[l], median}}.triangles(
               error);
  }
};

}  // namespace translucube
