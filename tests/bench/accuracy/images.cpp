#include "tests/bench/accuracy/images.h"

#include <algorithm>
#include <cmath>

namespace translucube::accuracy {

using test::Estimate;

SceneSpec peer_scene(const Coefficients& coefficients, int size, std::uint64_t seed) {
  SceneSpec spec;
  spec.material.coefficients = coefficients;
  spec.material.absorber = RgbAbsorber{{0.15, 1, 1}};
  spec.object = SphereObject{1};
  spec.environment.source =
      ImageEnvironmentSpec{TRANSLUCUBE_SOURCE_DIR "/config/environments/forest.exr"};
  spec.camera = {{0, 0, 4.5}, {0, 0, 0}, {0, 1, 0}, 32};
  spec.width = spec.height = size;
  spec.seed = seed;
  return spec;
}

std::array<Estimate, 3> channel_means(const Film& film) {
  const Image image = develop(film), spread = variance(film);
  const double n = static_cast<double>(image.pixels.size()) / 3;
  std::array<Estimate, 3> means{};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    means[i % 3].mean += image.pixels[i] / n;
    means[i % 3].standard_error += spread.pixels[i];
  }
  for (Estimate& e : means) e.standard_error = std::sqrt(e.standard_error) / n;
  return means;
}

Estimate mean_luminance(const Film& film) {
  const auto [r, g, b] = channel_means(film);
  // The channels share their paths: their errors add up.
  const auto weighted = [](double x, double y, double z) {
    return 0.2126 * x + 0.7152 * y + 0.0722 * z;
  };
  return {weighted(r.mean, g.mean, b.mean),
          weighted(r.standard_error, g.standard_error, b.standard_error)};
}

namespace {

double smoothed(const Image& image, int x, int y, int c) {
  double sum = 0;
  int n = 0;
  for (int v = std::max(0, y - 2); v <= std::min(image.height - 1, y + 2); ++v)
    for (int u = std::max(0, x - 2); u <= std::min(image.width - 1, x + 2); ++u, ++n)
      sum += image.pixels[3 * (std::size_t(v) * image.width + u) + c];
  return sum / n;
}

}  // namespace

Estimate rel_mse(const Film& film, const Film& reference) {
  const Image x = develop(film), r = develop(reference);
  const Image vx = variance(film), vr = variance(reference);
  const double n = static_cast<double>(x.pixels.size());
  const double freedom = std::min(film.passes, reference.passes) - 1.0;
  Estimate mse;
  for (std::size_t i = 0; i < x.pixels.size(); ++i) {
    const auto pixel = static_cast<int>(i / 3);
    const double ref = smoothed(r, pixel % r.width, pixel / r.width, static_cast<int>(i % 3));
    const double scale = 1 / (ref * ref + 0.01) / n;
    const double d = x.pixels[i] - r.pixels[i], v = vx.pixels[i] + vr.pixels[i];
    mse.mean += (d * d - v) * scale;
    // Var d^2 = 4 D^2 v + 2 v^2 with D^2 = E d^2 - v, and v itself is estimated.
    mse.standard_error +=
        std::fmax(0.0, 4 * d * d * v - 2 * v * v + 2 * v * v / freedom) * scale * scale;
  }
  // The channels of a pixel share its paths: their errors add up, so that 3 times the variance.
  mse.standard_error = std::sqrt(3 * mse.standard_error);
  return mse;
}

}  // namespace translucube::accuracy
