// What a render says of its own error, against many renders.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/render.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

TEST(RelativeError, IsTheErrorAgainstAnIndependentRender) {
  Scene scene = half_lit_sphere();
  const RenderResult result = render(scene, ErrorTarget{0.05}, 0);
  EXPECT_LE(result.stats.relative_error, 0.05);
  scene.seed = 77;
  const Image reference = develop(trace(scene, 16 * result.film.samples));
  const Image image = develop(result.film);
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double d = image.pixels[i] - reference.pixels[i], r = reference.pixels[i];
    sum += d * d / (r * r + 0.01);
  }
  const double error = std::sqrt(sum / static_cast<double>(image.pixels.size()));
  EXPECT_NEAR(result.stats.relative_error / error, 1, 0.25);
}

TEST(Variance, OfThePixelsIsTheSpreadBetweenSeeds) {
  Scene scene = half_lit_sphere();
  double spread = 0, estimate = 0;
  std::vector<double> sum(40 * 40 * 3, 0), squares(40 * 40 * 3, 0);
  constexpr int runs = 24;
  for (int run = 0; run < runs; ++run) {
    scene.seed = 100 + run;
    const Film film = trace(scene, 32);
    const Image image = develop(film), v = variance(film);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += image.pixels[i];
      squares[i] += double(image.pixels[i]) * image.pixels[i];
      estimate += v.pixels[i] / runs;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    spread += (squares[i] - sum[i] * sum[i] / runs) / (runs - 1);
  EXPECT_NEAR(estimate / spread, 1, 0.1);
}

}  // namespace
}  // namespace translucube::test
