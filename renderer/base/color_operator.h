#pragma once

// Operators on colours, and tables of them over a range of many octaves.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/base/octave_grid.h"
#include "renderer/base/vec.h"

namespace translucube {

/// A linear map from RGB to RGB, row-major.
using ColorOperator = std::array<float, 9>;
inline constexpr ColorOperator identity_operator{1, 0, 0, 0, 1, 0, 0, 0, 1};
inline Rgb apply_operator(const ColorOperator& m, Rgb c) {
  return {m[0] * c.r + m[1] * c.g + m[2] * c.b, m[3] * c.r + m[4] * c.g + m[5] * c.b,
          m[6] * c.r + m[7] * c.g + m[8] * c.b};
}
/// The operator of b first, then a.
inline ColorOperator multiply(const ColorOperator& a, const ColorOperator& b) {
  ColorOperator m{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) m[3 * i + j] += a[3 * i + k] * b[3 * k + j];
  return m;
}

/// An operator as a function of x >= 1, linear within 32 segments to the octave.
class ColorOperatorTable {
 public:
  using Grid = OctaveGrid<float, 5>;
  /// Column-major, each column a register of four.
  struct Node {
    float column[3][4] = {};
  };

  /// Zero everywhere.
  ColorOperatorTable() : nodes_(2) {}
  /// `value(x)` for x up to 2^octaves, octaves > 0; from there on it stays.
  template <class Value>
  ColorOperatorTable(int octaves, Value&& value) : nodes_(Grid::nodes(octaves)) {
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      const ColorOperator m = value(Grid::at(node));
      for (int i = 0; i < 9; ++i) nodes_[node].column[i % 3][i / 3] = m[i];
    }
  }

  ColorOperator at(double x) const {
    const auto [position, t] = Grid::place(static_cast<float>(x));
    const std::size_t segment = std::min(position, segments() - 1);
    const Node &a = nodes_[segment], &b = nodes_[segment + 1];
    ColorOperator m;
    for (int i = 0; i < 9; ++i) {
      const float from = a.column[i % 3][i / 3], to = b.column[i % 3][i / 3];
      m[i] = from + t * (to - from);
    }
    return m;
  }

  // What those read who apply many at a time.
  static constexpr int fraction_bits = Grid::fraction_bits;
  static constexpr std::uint32_t fraction_mask = Grid::fraction_mask;
  const Node* nodes() const { return nodes_.data(); }
  std::size_t segments() const { return nodes_.size() - 1; }

 private:
  std::vector<Node> nodes_;
};

}  // namespace translucube
