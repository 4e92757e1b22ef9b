#include "renderer/light/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "renderer/base/huge_pages.h"
#include "renderer/light/environment_batch.h"

namespace translucube {

using std::numbers::pi;

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

struct ImageEnvironment::Tables {
  HugePageVector<Texel> texels;
  HugePageVector<double> blocks;
  HugePageVector<float> rows, cells;
};

ImageEnvironment::ImageEnvironment(const Image& image, double rotation_rad, double scale,
                                   EnvironmentSide side)
    : width_(image.width), height_(image.height), rotation_rad_(rotation_rad), side_(side) {
  const auto tables = std::make_shared<Tables>();
  tables->texels.resize(std::size_t(width_) * height_);
  for (std::size_t i = 0; i < tables->texels.size(); ++i) {
    const float* p = &image.pixels[3 * i];
    const auto s = static_cast<float>(scale);
    tables->texels[i] = {p[0] * s, p[1] * s, p[2] * s, 0};
  }
  build_sampling(*tables);
  texels_ = tables->texels;
  blocks_ = tables->blocks;
  rows_ = tables->rows;
  cells_ = tables->cells;
  tables_ = tables;
  build_irradiance();
}

bool ImageEnvironment::hides(int column) const {
  if (side_ == EnvironmentSide::all || width_ < 4) return false;
  const auto is_behind = [&](int border) {
    return std::cos(2 * pi * (0.5 - double(border) / width_) + rotation_rad_) < 0;
  };
  return is_behind(column) && is_behind(column + 1);
}

void ImageEnvironment::build_sampling(Tables& tables) {
  auto& [texels, blocks, rows, cells] = tables;
  // The integral of the bilinear interpolant over a cell is its tent filter (1, 6, 1) / 8.
  HugePageVector<double> across;  // the filter along the rows
  across.reserve(texels.size());
  for (int y = 0; y < height_; ++y) {
    std::vector<double> row;
    row.reserve(width_ + 2);
    const auto add = [&](int x) {
      const Texel& t = texels[std::size_t(y) * width_ + x];
      // Photographs hold slightly negative pixels: they are light that must be found like any
      // other.
      row.push_back(static_cast<double>(std::fabs(luminance({t.r, t.g, t.b}))));
    };
    add(width_ - 1);
    for (int x = 0; x < width_; ++x) add(x);
    add(0);
    for (int x = 0; x < width_; ++x) across.push_back(row[x] + 6 * row[x + 1] + row[x + 2]);
  }
  const auto row = [&](int x, int y) {
    return across[std::size_t(std::clamp(y, 0, height_ - 1)) * width_ + x];
  };
  const std::size_t n = texels.size();
  HugePageVector<double> weight(n);
  std::vector<char> hidden;
  hidden.reserve(width_);
  for (int x = 0; x < width_; ++x) hidden.push_back(hides(x));
  double total = 0;
  for (int y = 0; y < height_; ++y) {
    const double solid_angle = std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_);
    for (int x = 0; x < width_; ++x) {
      if (hidden[x]) continue;
      const double mean = (row(x, y - 1) + 6 * row(x, y) + row(x, y + 1)) / 64;
      total += weight[std::size_t(y) * width_ + x] = mean * solid_angle;
    }
  }
  if (total <= 0) {  // a black map: any density will do
    std::ranges::fill(weight, 1.0);
    total = static_cast<double>(n);
  }
  for (std::size_t i = 0; i < n; ++i) {
    weight[i] *= static_cast<double>(n) / total;
    texels[i].weight = static_cast<float>(weight[i]);
  }
  blocks_across_ = (width_ + block_size - 1) / block_size;
  const int blocks_down = (height_ + block_size - 1) / block_size;
  blocks.reserve(std::size_t(blocks_across_) * blocks_down);
  cells.reserve(blocks.capacity() * cells_of_a_block);
  rows.reserve(blocks.capacity() * block_size);
  double all = 0;
  for (int by = 0; by < blocks_down; ++by)
    for (int bx = 0; bx < blocks_across_; ++bx) {
      std::array<double, cells_of_a_block> sums{};
      double sum = 0;
      for (int i = 0; i < cells_of_a_block; ++i) {
        const int x = bx * block_size + i % block_size, y = by * block_size + i / block_size;
        if (x < width_ && y < height_) sum += weight[std::size_t(y) * width_ + x];
        sums[i] = sum;
      }
      for (int i = 0; i < cells_of_a_block; ++i) {
        cells.push_back(sum > 0 ? static_cast<float>(sums[i] / sum) : 0);
        if (i % block_size == block_size - 1) rows.push_back(cells.back());
      }
      blocks.push_back(all += sum / static_cast<double>(n));
    }
  for (double& sum : blocks) sum /= all;
}

namespace {

/// The real spherical harmonics up to the second order, without their norms.
std::array<double, 9> quadratic_basis(Vec3 n) {
  return {
      1, n.x, n.y, n.z, n.x * n.y, n.y * n.z, n.x * n.z, 3 * n.z * n.z - 1, n.x * n.x - n.y * n.y};
}

}  // namespace

void ImageEnvironment::build_irradiance() {
  // Their squared norms over 4 pi, and those of the clamped cosine: pi, 2 pi / 3, pi / 4.
  constexpr std::array<double, 9> norm{1, 3, 3, 3, 15, 15, 15, 5. / 4, 15. / 4};
  constexpr std::array<double, 9> lobe{1, 2. / 3, 2. / 3, 2. / 3, .25, .25, .25, .25, .25};
  std::array<std::array<double, 3>, 9> moments{};
  std::vector<double> sines, cosines;
  std::vector<int> columns;
  for (int x = 0; x < width_; ++x) {
    if (hides(x)) continue;
    columns.push_back(x);
    const double azimuth = 2 * pi * (0.5 - (x + 0.5) / width_) + rotation_rad_;
    sines.push_back(std::sin(azimuth));
    cosines.push_back(std::cos(azimuth));
  }
  for (int y = 0; y < height_; ++y) {
    const double theta = pi * (y + 0.5) / height_, sin_theta = std::sin(theta);
    const double solid_angle =
        2 * pi / width_ * (std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::array<double, 9> basis =
          quadratic_basis({sin_theta * sines[i], std::cos(theta), sin_theta * cosines[i]});
      const Texel& t = texels_[std::size_t(y) * width_ + columns[i]];
      for (std::size_t k = 0; k < 9; ++k) {
        moments[k][0] += solid_angle * basis[k] * t.r;
        moments[k][1] += solid_angle * basis[k] * t.g;
        moments[k][2] += solid_angle * basis[k] * t.b;
      }
    }
  }
  for (std::size_t i = 0; i < 9; ++i) {
    const double scale = norm[i] * lobe[i] / 4;
    irradiance_[i] = {static_cast<float>(scale * moments[i][0]),
                      static_cast<float>(scale * moments[i][1]),
                      static_cast<float>(scale * moments[i][2])};
  }
}

std::array<Rgb, 3> ImageEnvironment::irradiance_by_order(Vec3 n) const {
  const std::array<double, 9> basis = quadratic_basis(n);
  std::array<Rgb, 3> orders;
  for (std::size_t i = 0; i < 9; ++i)
    orders[i == 0 ? 0 : i < 4 ? 1 : 2] += irradiance_[i] * static_cast<float>(basis[i]);
  return orders;
}

MapCoordinates ImageEnvironment::coordinates(Vec3 d) const {
  const double azimuth =
      std::atan2(static_cast<float>(d.x), static_cast<float>(d.z)) - rotation_rad_;
  double u = 0.5 - azimuth / (2 * pi);
  u -= std::floor(u);
  const auto cos_theta = static_cast<float>(std::clamp(d.y, -1.0, 1.0));
  const auto sin_theta = static_cast<float>(std::sqrt(d.x * d.x + d.z * d.z));
  return {static_cast<float>(u * width_),
          std::atan2(sin_theta, cos_theta) * static_cast<float>(height_ / pi), sin_theta};
}

Rgb ImageEnvironment::bilinear(float x, float y) const {
  const float fx = x - 0.5f, fy = y - 0.5f;
  const float x_floor = std::floor(fx), y_floor = std::floor(fy);
  const float tx = fx - x_floor, ty = fy - y_floor;
  int x0 = static_cast<int>(x_floor), y0 = static_cast<int>(y_floor);
  int x1 = x0 + 1, y1 = y0 + 1;
  if (x0 < 0) x0 += width_;
  if (x1 >= width_) x1 -= width_;
  x0 = std::min(x0, width_ - 1);
  y0 = std::clamp(y0, 0, height_ - 1);
  y1 = std::clamp(y1, 0, height_ - 1);
  const Texel* upper = &texels_[std::size_t(y0) * width_];
  const Texel* lower = &texels_[std::size_t(y1) * width_];
  const float w00 = (1 - tx) * (1 - ty), w10 = tx * (1 - ty), w01 = (1 - tx) * ty, w11 = tx * ty;
  const Texel &a = upper[x0], &b = upper[x1], &c = lower[x0], &d = lower[x1];
  return {w00 * a.r + w10 * b.r + w01 * c.r + w11 * d.r,
          w00 * a.g + w10 * b.g + w01 * c.g + w11 * d.g,
          w00 * a.b + w10 * b.b + w01 * c.b + w11 * d.b};
}

double ImageEnvironment::cell_pdf(int x, int y, double sin_theta) const {
  // Uniform in (u, v) within a cell: du dv = d omega / (2 pi^2 sin theta).
  const Texel& t = texels_[std::size_t(y) * width_ + x];
  return t.weight / (2 * pi * pi * std::fmax(sin_theta, 1e-12));
}

EnvironmentValue ImageEnvironment::value_at(MapCoordinates at) const {
  const int x = std::clamp(static_cast<int>(at.x), 0, width_ - 1);
  const int y = std::clamp(static_cast<int>(at.y), 0, height_ - 1);
  return {bilinear(at.x, at.y), cell_pdf(x, y, at.sin_theta)};
}

MapGeometry ImageEnvironment::geometry() const {
  return {static_cast<float>(width_), static_cast<float>(height_),
          static_cast<float>(rotation_rad_)};
}

void ImageEnvironment::prefetch(float x, float y) const {
  const int column = std::clamp(static_cast<int>(x - 0.5f), 0, width_ - 1);
  const int row = std::clamp(static_cast<int>(y - 0.5f), 0, height_ - 1);
  const Texel* upper = &texels_[std::size_t(row) * width_ + column];
  __builtin_prefetch(upper);
  __builtin_prefetch(upper + (row + 1 < height_ ? width_ : 0));
}

ImageEnvironment::Draw ImageEnvironment::draw_block(double u, std::size_t at_least) const {
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

void ImageEnvironment::draw_row(Draw& draw) const {
  draw.row = passed<block_size - 1>(&rows_[draw.block * block_size], draw.rest);
}

MapCoordinates ImageEnvironment::draw_cell(const Draw& draw, double v) const {
  const float* cells = &cells_[draw.block * cells_of_a_block];
  const float* row = cells + draw.row * block_size;
  const int column = passed<block_size - 1>(row, draw.rest);
  const int cell = draw.row * block_size + column;
  const float below = cell > 0 ? cells[cell - 1] : 0;
  const auto bx = static_cast<int>(draw.block) % blocks_across_,
             by = static_cast<int>(draw.block) / blocks_across_;
  const float x =
      static_cast<float>(bx * block_size + column) +
      std::clamp((draw.rest - below) / std::fmax(cells[cell] - below, 1e-30f), 0.0f, 1.0f);
  const float y = static_cast<float>(by * block_size + draw.row) + static_cast<float>(v);
  return {x, y, 0};
}

Vec3 ImageEnvironment::direction(MapCoordinates at) const {
  const double azimuth = 2 * pi * (0.5 - at.x / width_) + rotation_rad_;
  return {at.sin_theta * std::sin(azimuth), std::cos(pi * at.y / height_),
          at.sin_theta * std::cos(azimuth)};
}

EnvironmentSample ImageEnvironment::sample(Sample2 u) const {
  Draw draw = draw_block(u.u, 0);
  draw_row(draw);
  MapCoordinates at = draw_cell(draw, u.v);
  at.sin_theta = std::sin(static_cast<float>(pi) / static_cast<float>(height_) * at.y);
  const Vec3 towards = direction(at);
  return {towards, seen(towards, value_at(at))};
}

std::vector<EnvironmentSample> ImageEnvironment::sample(std::span<const Sample2> u) const {
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
  std::vector<EnvironmentSample> samples(u.size());
  MapDirections batch;
  for (std::size_t first = 0; first < u.size(); first += MapDirections::capacity) {
    batch.size = std::min(MapDirections::capacity, u.size() - first);
    for (std::size_t i = 0; i < batch.size; ++i) {
      const MapCoordinates at = draw_cell(draws[first + i], u[first + i].v);
      prefetch(at.x, at.y);
      batch.u[i] = at.x;
      batch.v[i] = at.y;
    }
    batch.find(geometry());
    for (std::size_t i = 0; i < batch.size; ++i) {
      const Vec3 towards = batch.direction[i];
      samples[first + i] = {towards,
                            seen(towards, value_at({batch.u[i], batch.v[i], batch.sin_theta[i]}))};
    }
  }
  return samples;
}

}  // namespace translucube
