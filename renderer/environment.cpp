#include "renderer/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace translucube {

using std::numbers::pi;

ImageEnvironment::ImageEnvironment(const Image& image, double rotation_rad, double scale)
    : width_(image.width), height_(image.height), rotation_rad_(rotation_rad) {
  texels_.resize(std::size_t(width_) * height_);
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    const float* p = &image.pixels[3 * i];
    const auto s = static_cast<float>(scale);
    texels_[i] = {p[0] * s, p[1] * s, p[2] * s, 0};
  }
  build_sampling();
  build_irradiance();
}

void ImageEnvironment::build_sampling() {
  // The integral of the bilinear interpolant over a cell is its tent filter (1, 6, 1) / 8.
  const auto at = [&](int x, int y) {
    const Texel& t =
        texels_[std::size_t(std::clamp(y, 0, height_ - 1)) * width_ + (x + width_) % width_];
    // Photographs hold slightly negative pixels: they are light that must be found like any other.
    return static_cast<double>(std::fabs(luminance({t.r, t.g, t.b})));
  };
  const auto row = [&](int x, int y) { return at(x - 1, y) + 6 * at(x, y) + at(x + 1, y); };
  const std::size_t n = texels_.size();
  std::vector<double> weight(n);
  double total = 0;
  for (int y = 0; y < height_; ++y) {
    const double solid_angle = std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_);
    for (int x = 0; x < width_; ++x) {
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
    texels_[i].weight = static_cast<float>(weight[i]);
  }
  alias_.resize(n);
  std::vector<std::uint32_t> small, large;
  for (std::uint32_t i = 0; i < n; ++i) (weight[i] < 1 ? small : large).push_back(i);
  while (!small.empty() && !large.empty()) {
    const std::uint32_t s = small.back(), l = large.back();
    small.pop_back();
    alias_[s] = {static_cast<float>(weight[s]), l};
    weight[l] -= 1 - weight[s];
    if (weight[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
  for (std::uint32_t i : small) alias_[i] = {1, i};
  for (std::uint32_t i : large) alias_[i] = {1, i};
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
  for (int y = 0; y < height_; ++y) {
    const double theta = pi * (y + 0.5) / height_, sin_theta = std::sin(theta);
    const double solid_angle =
        2 * pi / width_ * (std::cos(pi * y / height_) - std::cos(pi * (y + 1) / height_));
    for (int x = 0; x < width_; ++x) {
      const double azimuth = 2 * pi * (0.5 - (x + 0.5) / width_) + rotation_rad_;
      const std::array<double, 9> basis = quadratic_basis(
          {sin_theta * std::sin(azimuth), std::cos(theta), sin_theta * std::cos(azimuth)});
      const Texel& t = texels_[std::size_t(y) * width_ + x];
      for (std::size_t i = 0; i < 9; ++i) {
        moments[i][0] += solid_angle * basis[i] * t.r;
        moments[i][1] += solid_angle * basis[i] * t.g;
        moments[i][2] += solid_angle * basis[i] * t.b;
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

Rgb ImageEnvironment::irradiance(Vec3 n) const {
  const std::array<Rgb, 3> orders = irradiance_by_order(n);
  return orders[0] + orders[1] + orders[2];
}

std::array<Rgb, 3> ImageEnvironment::irradiance_by_order(Vec3 n) const {
  const std::array<double, 9> basis = quadratic_basis(n);
  std::array<Rgb, 3> orders;
  for (std::size_t i = 0; i < 9; ++i)
    orders[i == 0 ? 0 : i < 4 ? 1 : 2] += irradiance_[i] * static_cast<float>(basis[i]);
  return orders;
}

ImageEnvironment::Coordinates ImageEnvironment::coordinates(Vec3 d) const {
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

Rgb ImageEnvironment::radiance_from(Vec3 direction) const {
  const Coordinates c = coordinates(direction);
  return bilinear(c.x, c.y);
}

EnvironmentValue ImageEnvironment::value_from(Vec3 direction) const {
  const Coordinates c = coordinates(direction);
  const int x = std::clamp(static_cast<int>(c.x), 0, width_ - 1);
  const int y = std::clamp(static_cast<int>(c.y), 0, height_ - 1);
  return {bilinear(c.x, c.y), cell_pdf(x, y, c.sin_theta)};
}

ImageEnvironment::Drawn ImageEnvironment::draw(Sample2 u) const {
  const double position = u.u * static_cast<double>(alias_.size());
  auto cell = std::min(static_cast<std::size_t>(position), alias_.size() - 1);
  double fraction = position - static_cast<double>(cell);
  const Alias& alias = alias_[cell];
  if (fraction < alias.keep) {
    fraction /= alias.keep;
  } else {
    fraction = (fraction - alias.keep) / (1 - alias.keep);
    cell = alias.other;
  }
  const int x = static_cast<int>(cell % width_), y = static_cast<int>(cell / width_);
  return {x, y, x + std::fmin(fraction, 1.0), y + u.v};
}

EnvironmentSample ImageEnvironment::at(const Drawn& drawn) const {
  const double theta = pi * drawn.py / height_;
  const double azimuth = 2 * pi * (0.5 - drawn.px / width_) + rotation_rad_;
  const double sin_theta = std::sin(theta);
  return {{sin_theta * std::sin(azimuth), std::cos(theta), sin_theta * std::cos(azimuth)},
          {bilinear(static_cast<float>(drawn.px), static_cast<float>(drawn.py)),
           cell_pdf(drawn.x, drawn.y, sin_theta)}};
}

EnvironmentSample ImageEnvironment::sample(Sample2 u) const { return at(draw(u)); }

std::vector<EnvironmentSample> ImageEnvironment::sample(std::span<const Sample2> u) const {
  const auto texel = [&](int x, int y) {
    return &texels_[std::size_t(std::clamp(y, 0, height_ - 1)) * width_ + x];
  };
  for (const Sample2& sample : u)
    __builtin_prefetch(&alias_[static_cast<std::size_t>(sample.u * double(alias_.size()))]);
  std::vector<Drawn> drawn;
  drawn.reserve(u.size());
  for (const Sample2& sample : u) {
    drawn.push_back(draw(sample));
    for (int row = -1; row <= 1; ++row)
      __builtin_prefetch(texel(drawn.back().x, drawn.back().y + row));
  }
  std::vector<EnvironmentSample> samples;
  samples.reserve(u.size());
  for (const Drawn& place : drawn) samples.push_back(at(place));
  return samples;
}

}  // namespace translucube
