#include "renderer/slab/tally.h"

#include <algorithm>

namespace translucube::slab {

Tally::Tally(double sigma_a_peak) : sigma_a_peak_(sigma_a_peak) {
  for (std::vector<double>& weights : weights_) weights.resize(sigma_a_peak > 0 ? nodes : 1);
}

void Tally::add(Exit exit, double weight, double length) {
  std::vector<double>& weights = weights_[static_cast<int>(exit)];
  if (sigma_a_peak_ == 0) {  // no length matters
    weights[0] += weight;
    return;
  }
  const auto [segment, t] = Grid::place(1 + sigma_a_peak_ * length);
  if (segment >= nodes - 1) {
    weights[nodes - 1] += weight;
    used_ = nodes;
    return;
  }
  weights[segment] += weight * (1 - t);
  weights[segment + 1] += weight * t;
  used_ = std::max(used_, segment + 2);
}

}  // namespace translucube::slab
