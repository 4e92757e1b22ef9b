#include "renderer/light/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/base/huge_pages.h"
#include "renderer/light/cell_sampler.h"
#include "renderer/light/environment_batch.h"

namespace translucube {

using std::numbers::pi;

struct ImageEnvironment::Tables {
  HugePageVector<Texel> texels;
  CellSampler cells;
};

ImageEnvironment::ImageEnvironment(const Image& image, double rotation_rad, double scale,
                                   EnvironmentSide side)
    : width_(image.width), height_(image.height), rotation_rad_(rotation_rad), side_(side) {
  HugePageVector<Texel> texels(std::size_t(width_) * height_);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const float* p = &image.pixels[3 * i];
    const auto s = static_cast<float>(scale);
    texels[i] = {p[0] * s, p[1] * s, p[2] * s, 0};
  }
  const HugePageVector<double> weights = cell_weights(texels);
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i].weight = static_cast<float>(weights[i]);
  tables_ = std::make_shared<const Tables>(
      Tables{std::move(texels), CellSampler(width_, height_, weights)});
  texels_ = tables_->texels;
  build_irradiance();
}

bool ImageEnvironment::hides(int column) const {
  if (side_ != EnvironmentSide::front || width_ < 4) return false;
  const auto is_behind = [&](int border) {
    return std::cos(2 * pi * (0.5 - double(border) / width_) + rotation_rad_) < 0;
  };
  return is_behind(column) && is_behind(column + 1);
}

HugePageVector<double> ImageEnvironment::cell_weights(std::span<const Texel> texels) const {
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
  HugePageVector<double> weights(texels.size());
  std::vector<char> hidden;
  hidden.reserve(width_);
  for (int x = 0; x < width_; ++x) hidden.push_back(hides(x));
  double total = 0;
  for (int y = 0; y < rows_seen(); ++y) {
    const double solid_angle = std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_);
    for (int x = 0; x < width_; ++x) {
      if (hidden[x]) continue;
      const double mean = (row(x, y - 1) + 6 * row(x, y) + row(x, y + 1)) / 64;
      total += weights[std::size_t(y) * width_ + x] = mean * solid_angle;
    }
  }
  const auto n = static_cast<double>(texels.size());
  if (total <= 0) {  // a black map: any density will do
    std::ranges::fill(weights, 1.0);
    total = n;
  }
  for (double& weight : weights) weight *= n / total;
  return weights;
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
  for (int y = 0; y < rows_seen(); ++y) {
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

Vec3 ImageEnvironment::direction(MapCoordinates at) const {
  const double azimuth = 2 * pi * (0.5 - at.x / width_) + rotation_rad_;
  return {at.sin_theta * std::sin(azimuth), std::cos(pi * at.y / height_),
          at.sin_theta * std::cos(azimuth)};
}

EnvironmentSample ImageEnvironment::sample(Sample2 u) const {
  const auto [x, y] = tables_->cells.draw(u);
  const MapCoordinates at{x, y, std::sin(static_cast<float>(pi) / static_cast<float>(height_) * y)};
  const Vec3 towards = direction(at);
  return {towards, seen(towards, value_at(at))};
}

std::vector<EnvironmentSample> ImageEnvironment::sample(std::span<const Sample2> u) const {
  const std::vector<CellPlace> places = tables_->cells.draw(u);
  std::vector<EnvironmentSample> samples(u.size());
  MapDirections batch;
  for (std::size_t first = 0; first < u.size(); first += MapDirections::capacity) {
    batch.size = std::min(MapDirections::capacity, u.size() - first);
    for (std::size_t i = 0; i < batch.size; ++i) {
      const auto [x, y] = places[first + i];
      prefetch(x, y);
      batch.u[i] = x;
      batch.v[i] = y;
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
