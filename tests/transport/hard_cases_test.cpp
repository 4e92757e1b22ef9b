// Hard cases (docs/design.md section 6): finite, unbiased, bounded in time, and nothing truncated where
// no light is trapped. In a white furnace the right answer is 1 whatever the body.

#include "tests/support/hard_cases.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "tests/support/repository.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

class HardCases : public testing::TestWithParam<HardCase> {};

TEST_P(HardCases, IsFiniteUnbiasedAndBoundedInTime) {
  const HardCase& c = GetParam();
  const auto scene = build_scene(hard_furnace(c.radius_mm, c.alpha, c.sigma_s, c.ior, c.g));
  const auto start = std::chrono::steady_clock::now();
  const Film film = trace(*scene, c.samples);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const Measured e = image_mean(film);
  EXPECT_EQ(film.counters.nan_samples, 0u);
  EXPECT_EQ(film.counters.truncated_energy, 0);
  EXPECT_NEAR(e.mean, 1, std::fmax(1e-3, 4 * e.standard_error));
  EXPECT_LT(e.standard_error, 5e-3);
  EXPECT_LT(took.count(), 60);
}

INSTANTIATE_TEST_SUITE_P(Furnace, HardCases, testing::ValuesIn(hard_cases),
                         [](const auto& hard) { return std::string(hard.param.name); });

TEST(HardCase, ASunOf34000StaysFiniteAndItsMeanIsThatOfAnotherSeed) {
  for (const double sigma_s : {0.0, 1.0, 10.0}) {
    SceneSpec spec = hard_furnace(1, 0.2, sigma_s, 1.5, 0);
    spec.environment.source =
        ImageEnvironmentSpec{in_repository("config/environments/sunrise.exr")};
    const Film first = trace(*build_scene(spec), 256);
    spec.seed = 2;
    const Film second = trace(*build_scene(spec), 256);
    EXPECT_EQ(first.counters.nan_samples + second.counters.nan_samples, 0u);
    const Measured a = image_mean(first), b = image_mean(second);
    EXPECT_NEAR(a.mean, b.mean, 5 * std::hypot(a.standard_error, b.standard_error)) << sigma_s;
  }
}

TEST(HardCase, GrazingViewsOfTheSilhouetteAreUnbiased) {
  for (const double alpha : {0.0, 1e-3, 0.5}) {
    SceneSpec spec = hard_furnace(1, alpha, 1, 1.5, 0);
    // The last hundredth of the sphere's disc.
    spec.camera.target_mm = {0.999, 0, 0};
    spec.camera.vfov_deg = 0.1;
    const Film film = trace(*build_scene(spec), 256);
    EXPECT_EQ(film.counters.nan_samples, 0u);
    EXPECT_NEAR(image_mean(film).mean, 1, 2e-3 + 4 * image_mean(film).standard_error) << alpha;
  }
}

TEST(HardCase, ACameraInsideTheBodySeesTheFurnaceToo) {
  // Basic radiance, radiance over the index squared, is 1 everywhere in a furnace, inside as
  // outside.
  for (const double alpha : {0.0, 0.3}) {
    SceneSpec spec = hard_furnace(1, alpha, 5, 1.5, 0);
    spec.camera.position_mm = {0.2, 0.1, 0.3};
    spec.camera.vfov_deg = 90;
    const Measured e = image_mean(trace(*build_scene(spec), 512));
    EXPECT_NEAR(e.mean, 1, 3 * e.standard_error + 1e-4) << alpha;
    EXPECT_LT(e.standard_error, 3e-3);
  }
}

TEST(HardCase, ACameraInsideAnOpaqueBodyIsRefused) {
  SceneSpec spec = hard_furnace(1, 0, std::numeric_limits<double>::infinity(), 1.5, 0);
  spec.camera.position_mm = {0, 0, 0.5};
  EXPECT_THROW(build_scene(spec), SceneError);
}

}  // namespace
}  // namespace translucube::test
