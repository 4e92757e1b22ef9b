#pragma once

// Absorption is not traced: a tally keeps the weight of the light that leaves over the length it
// travelled inside, and any absorber is developed from it (docs/design.md section 1).

#include <array>
#include <cstddef>
#include <vector>

#include "renderer/base/octave_grid.h"
#include "renderer/slab/body.h"

namespace translucube::slab {

/// Weight over length for every exit. The nodes are linear in 1 + sigma_peak l within an octave:
/// an exponential absorption exp(-sigma l), sigma <= sigma_peak, is interpolated to 4e-6.
class Tally {
 public:
  using Grid = OctaveGrid<double, 7>;
  static constexpr std::size_t nodes = Grid::nodes(40);

  explicit Tally(double sigma_a_peak);

  void add(Exit exit, double weight, double length);
  const std::vector<double>& weights(Exit exit) const { return weights_[static_cast<int>(exit)]; }
  std::size_t used() const { return used_; }  ///< nodes from here on are empty
  /// sigma_peak l at a node.
  static double depth_at(std::size_t node) { return Grid::at(node) - 1; }

 private:
  double sigma_a_peak_;
  std::array<std::vector<double>, exit_count> weights_;
  std::size_t used_ = 1;
};

}  // namespace translucube::slab
