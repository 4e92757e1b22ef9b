#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "renderer/base/huge_pages.h"
#include "renderer/base/sampler.h"

namespace translucube {

/// A place in a map, in cells.
struct CellPlace {
  float x, y;
};

/// Draws places in a map: a cell in proportion to its weight, a place in it uniformly.
class CellSampler {
 public:
  /// `weights`: of width x height cells row by row, not negative, not all 0.
  CellSampler(int width, int height, std::span<const double> weights);

  /// Nearby u.u give nearby places.
  CellPlace draw(Sample2 u) const;
  /// Many of them, quickest where u.u ascends; what they read of a map larger than the caches is on
  /// its way meanwhile.
  std::vector<CellPlace> draw(std::span<const Sample2> u) const;

 private:
  // Drawing, step by step: each reads a cache line that is not likely to be near.
  struct Draw {
    std::size_t block;
    float rest;  ///< of the number u.u, within the block
    int row;
  };
  Draw draw_block(double u, std::size_t at_least) const;
  void draw_row(Draw& draw) const;
  CellPlace draw_cell(const Draw& draw, double v) const;

  // The chances of the cells, block by block of the map and summed up: over the blocks, and within
  // each over its rows and over its cells (row by row, 1 at its end).
  int blocks_across_;
  HugePageVector<double> blocks_;
  HugePageVector<float> rows_, cells_;
};

}  // namespace translucube
