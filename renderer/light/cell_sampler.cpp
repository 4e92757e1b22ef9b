#include "renderer/light/cell_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace translucube {

namespace {

constexpr int block_size = 16, cells_of_a_block = block_size * block_size;

/// How many of so many ascending values are not above x.
template <int count>
int passed(const float* values, float x) {
  int n = 0;
  for (int i = 0; i < count; ++i) n += values[i] <= x;
  return n;
}

}  // namespace

CellSampler::CellSampler(int width, int height, std::span<const double> weights)
    : blocks_across_((width + block_size - 1) / block_size) {
  const int blocks_down = (height + block_size - 1) / block_size;
  blocks_.reserve(std::size_t(blocks_across_) * blocks_down);
  cells_.reserve(blocks_.capacity() * cells_of_a_block);
  rows_.reserve(blocks_.capacity() * block_size);
  double all = 0;
  for (int by = 0; by < blocks_down; ++by)
    for (int bx = 0; bx < blocks_across_; ++bx) {
      std::array<double, cells_of_a_block> sums{};
      double sum = 0;
      for (int i = 0; i < cells_of_a_block; ++i) {
        const int x = bx * block_size + i % block_size, y = by * block_size + i / block_size;
        if (x < width && y < height) sum += weights[std::size_t(y) * width + x];
        sums[i] = sum;
      }
      for (int i = 0; i < cells_of_a_block; ++i) {
        cells_.push_back(sum > 0 ? static_cast<float>(sums[i] / sum) : 0);
        if (i % block_size == block_size - 1) rows_.push_back(cells_.back());
      }
      blocks_.push_back(all += sum / static_cast<double>(weights.size()));
    }
  for (double& sum : blocks_) sum /= all;
}

CellSampler::Draw CellSampler::draw_block(double u, std::size_t at_least) const {
  const auto last = blocks_.end() - 1;
  auto block = blocks_.begin() + static_cast<std::ptrdiff_t>(at_least);
  if (at_least > 0 && u < block[-1])
    block = std::upper_bound(blocks_.begin(), last, u);
  else
    for (int step = 0; block < last && *block <= u; ++step)
      block = step < 16 ? block + 1 : std::upper_bound(block, last, u);
  const double before = block > blocks_.begin() ? block[-1] : 0;
  return {static_cast<std::size_t>(block - blocks_.begin()),
          std::fmin(static_cast<float>((u - before) / (*block - before)), 0x1.fffffep-1f), 0};
}

void CellSampler::draw_row(Draw& draw) const {
  draw.row = passed<block_size - 1>(&rows_[draw.block * block_size], draw.rest);
}

CellPlace CellSampler::draw_cell(const Draw& draw, double v) const {
  const float* cells = &cells_[draw.block * cells_of_a_block];
  const float* row = cells + draw.row * block_size;
  const int column = passed<block_size - 1>(row, draw.rest);
  const int cell = draw.row * block_size + column;
  const float below = cell > 0 ? cells[cell - 1] : 0;
  const auto bx = static_cast<int>(draw.block) % blocks_across_,
             by = static_cast<int>(draw.block) / blocks_across_;
  return {static_cast<float>(bx * block_size + column) +
              std::clamp((draw.rest - below) / std::fmax(cells[cell] - below, 1e-30f), 0.0f, 1.0f),
          static_cast<float>(by * block_size + draw.row) + static_cast<float>(v)};
}

CellPlace CellSampler::draw(Sample2 u) const {
  Draw draw = draw_block(u.u, 0);
  draw_row(draw);
  return draw_cell(draw, u.v);
}

std::vector<CellPlace> CellSampler::draw(std::span<const Sample2> u) const {
  std::vector<Draw> draws;
  draws.reserve(u.size());
  for (const Sample2& sample : u) {
    draws.push_back(draw_block(sample.u, draws.empty() ? 0 : draws.back().block));
    __builtin_prefetch(&rows_[draws.back().block * block_size]);
  }
  for (Draw& draw : draws) {
    draw_row(draw);
    __builtin_prefetch(&cells_[draw.block * cells_of_a_block + draw.row * block_size]);
  }
  std::vector<CellPlace> places;
  places.reserve(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) places.push_back(draw_cell(draws[i], u[i].v));
  return places;
}

}  // namespace translucube
