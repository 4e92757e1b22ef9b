#pragma once

#include <array>
#include <span>

namespace translucube {

/// Lagrange's weights, times `all`, at x of the cubic through four nodes: what they give to the
/// nodes keeps every moment up to the third, and adds up to `all`.
template <class Number>
std::array<Number, 4> lagrange_weights(std::span<const Number, 4> nodes, Number x, Number all = 1) {
  std::array<Number, 4> weights;
  for (int i = 0; i < 4; ++i) {
    weights[i] = all;
    for (int j = 0; j < 4; ++j)
      if (j != i) weights[i] *= (x - nodes[j]) / (nodes[i] - nodes[j]);
  }
  return weights;
}

}  // namespace translucube
