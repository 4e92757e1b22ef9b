#include <bit>
#include <cmath>

#include "renderer/slab/walk.h"

namespace translucube {
namespace {

constexpr int fraction_bits = 52 - SlabTally::segment_bits;

}  // namespace

SlabTally::SlabTally(double sigma_a_peak) : sigma_a_peak_(sigma_a_peak) {
  for (std::vector<double>& weights : weights_) weights.resize(sigma_a_peak > 0 ? nodes : 1);
}

void SlabTally::add(SlabExit exit, double weight, double length) {
  std::vector<double>& weights = weights_[static_cast<int>(exit)];
  if (sigma_a_peak_ == 0) {  // no length matters
    weights[0] += weight;
    return;
  }
  // The exponent and the leading mantissa bits of 1 + sigma l are the segment, the rest is linear
  // in it.
  const std::uint64_t position =
      std::bit_cast<std::uint64_t>(1 + sigma_a_peak_ * length) - std::bit_cast<std::uint64_t>(1.0);
  const std::uint64_t segment = position >> fraction_bits;
  if (segment >= nodes - 1) {
    weights[nodes - 1] += weight;
    used_ = nodes;
    return;
  }
  const double t = std::ldexp(
      static_cast<double>(position & ((std::uint64_t{1} << fraction_bits) - 1)), -fraction_bits);
  weights[segment] += weight * (1 - t);
  weights[segment + 1] += weight * t;
  used_ = std::max<std::size_t>(used_, segment + 2);
}

double SlabTally::depth_at(std::size_t node) {
  const std::uint64_t bits =
      std::bit_cast<std::uint64_t>(1.0) + (std::uint64_t{node} << fraction_bits);
  return std::bit_cast<double>(bits) - 1;
}

}  // namespace translucube
