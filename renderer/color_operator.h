#pragma once

// Operators on colours, and tables of them over a range of many octaves.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "renderer/vec.h"

namespace translucube {

/// From RGB to RGB, row-major.
using ColorOperator = std::array<float, 9>;
inline constexpr ColorOperator identity_operator{1, 0, 0, 0, 1, 0, 0, 0, 1};
inline Rgb apply_operator(const ColorOperator& m, Rgb c) {
  return {m[0] * c.r + m[1] * c.g + m[2] * c.b, m[3] * c.r + m[4] * c.g + m[5] * c.b,
          m[6] * c.r + m[7] * c.g + m[8] * c.b};
}
/// First b, then a.
inline ColorOperator multiply(const ColorOperator& a, const ColorOperator& b) {
  ColorOperator m{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) m[3 * i + j] += a[3 * i + k] * b[3 * k + j];
  return m;
}

/// An operator as a function of x >= 1, linear within 32 segments of equal width to the octave.
class ColorOperatorTable {
 public:
  /// Zero everywhere.
  ColorOperatorTable() : nodes_(2) {}
  /// `value(x)` for x up to 2^octaves, octaves > 0; from there on it stays.
  template <class Value>
  ColorOperatorTable(int octaves, Value&& value) : nodes_(std::size_t(segments) * octaves + 1) {
    for (std::size_t node = 0; node < nodes_.size(); ++node)
      nodes_[node] = value(std::ldexp(1 + static_cast<double>(node % segments) / segments,
                                      static_cast<int>(node / segments)));
  }

  ColorOperator at(double x) const {
    // The exponent and the leading mantissa bits are the segment, the rest is linear in it.
    const std::uint32_t position =
        std::bit_cast<std::uint32_t>(static_cast<float>(x)) - std::bit_cast<std::uint32_t>(1.0f);
    constexpr int fraction_bits = 23 - segment_bits;
    const std::size_t segment = std::min<std::size_t>(position >> fraction_bits, nodes_.size() - 2);
    const float t =
        static_cast<float>(position & ((1u << fraction_bits) - 1)) * (1.0f / (1u << fraction_bits));
    const ColorOperator &a = nodes_[segment], &b = nodes_[segment + 1];
    ColorOperator m;
    for (int i = 0; i < 9; ++i) m[i] = a[i] + t * (b[i] - a[i]);
    return m;
  }

 private:
  static constexpr int segment_bits = 5, segments = 1 << segment_bits;

  std::vector<ColorOperator> nodes_;
};

}  // namespace translucube
