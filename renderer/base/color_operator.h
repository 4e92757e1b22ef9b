#pragma once

// Operators on colours, and tables of them over a range of many octaves.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "renderer/base/vec.h"

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
  /// Column-major, each column a register of four.
  struct Node {
    float column[3][4] = {};
  };

  /// Zero everywhere.
  ColorOperatorTable() : nodes_(2) {}
  /// `value(x)` for x up to 2^octaves, octaves > 0; from there on it stays.
  template <class Value>
  ColorOperatorTable(int octaves, Value&& value) : nodes_(std::size_t(to_octave) * octaves + 1) {
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      const ColorOperator m =
          value(std::ldexp(1 + static_cast<double>(node % to_octave) / to_octave,
                           static_cast<int>(node / to_octave)));
      for (int i = 0; i < 9; ++i) nodes_[node].column[i % 3][i / 3] = m[i];
    }
  }

  ColorOperator at(double x) const {
    const std::uint32_t position =
        std::bit_cast<std::uint32_t>(static_cast<float>(x)) - std::bit_cast<std::uint32_t>(1.0f);
    const std::size_t segment = std::min<std::size_t>(position >> fraction_bits, segments() - 1);
    const float t = static_cast<float>(position & fraction_mask) * (1.0f / (1u << fraction_bits));
    const Node &a = nodes_[segment], &b = nodes_[segment + 1];
    ColorOperator m;
    for (int i = 0; i < 9; ++i) {
      const float from = a.column[i % 3][i / 3], to = b.column[i % 3][i / 3];
      m[i] = from + t * (to - from);
    }
    return m;
  }

  // For those that apply many at a time. Of x as a float, less that of 1, the exponent and the
  // leading bits of the mantissa are the segment; in the rest the operator is linear.
  static constexpr int segment_bits = 5, fraction_bits = 23 - segment_bits;
  static constexpr std::uint32_t fraction_mask = (1u << fraction_bits) - 1;
  const Node* nodes() const { return nodes_.data(); }
  std::size_t segments() const { return nodes_.size() - 1; }

 private:
  static constexpr int to_octave = 1 << segment_bits;

  std::vector<Node> nodes_;
};

}  // namespace translucube
