#include "tests/bench/accuracy/images.h"

#include <algorithm>
#include <cmath>

namespace translucube::accuracy {

using test::Measured;

Measured mean_luminance(const Film& film) {
  const auto [r, g, b] = channel_means(film);
  // The channels share their paths: their errors add up.
  const auto weighted = [](double x, double y, double z) {
    return 0.2126 * x + 0.7152 * y + 0.0722 * z;
  };
  return {weighted(r.mean, g.mean, b.mean),
          weighted(r.standard_error, g.standard_error, b.standard_error)};
}

Measured rel_mse(const Film& film, const Film& reference) {
  const Image x = develop(film), r = develop(reference);
  const Image vx = variance(film), vr = variance(reference);
  const double n = static_cast<double>(x.pixels.size());
  const double freedom = std::min(film.passes, reference.passes) - 1.0;
  Measured mse;
  for (std::size_t i = 0; i < x.pixels.size(); ++i) {
    const auto pixel = static_cast<int>(i / 3);
    const double ref = test::smoothed(r, pixel % r.width, pixel / r.width, static_cast<int>(i % 3));
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
