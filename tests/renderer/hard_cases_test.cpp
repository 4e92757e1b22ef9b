// Hard cases (design.md section 6): finite, unbiased, bounded in time, and nothing truncated where
// no light is trapped. In a white furnace the right answer is 1 whatever the body.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

/// The request's scene under white light: a sphere of this radius that fills the image.
SceneSpec furnace(double radius_mm, double alpha, double sigma_s, double ior, double g) {
  SceneSpec spec;
  spec.material.coefficients = {0, alpha, sigma_s};
  spec.material.ior = ior;
  spec.material.g = g;
  spec.object = SphereObject{radius_mm};
  spec.camera.position_mm = {0, 0, 4.5 * radius_mm};
  spec.camera.vfov_deg = 15;
  spec.width = spec.height = 16;
  return spec;
}

struct Case {
  const char* name;
  double radius_mm, alpha, sigma_s, ior, g;
  std::uint32_t samples;
};

class HardCase : public testing::TestWithParam<Case> {};

TEST_P(HardCase, IsFiniteUnbiasedAndBoundedInTime) {
  const Case& c = GetParam();
  const auto scene = build_scene(furnace(c.radius_mm, c.alpha, c.sigma_s, c.ior, c.g));
  const auto start = std::chrono::steady_clock::now();
  const Film film = trace(*scene, c.samples);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const Estimate e = image_mean(film);
  EXPECT_EQ(film.counters.nan_samples, 0u);
  EXPECT_EQ(film.counters.truncated_energy, 0);
  EXPECT_NEAR(e.mean, 1, std::fmax(1e-3, 4 * e.standard_error));
  EXPECT_LT(e.standard_error, 5e-3);
  EXPECT_LT(took.count(), 60);
}

INSTANTIATE_TEST_SUITE_P(Furnace, HardCase,
                         testing::Values(Case{"alpha_1e_4", 1, 1e-4, 0, 1.5, 0, 256},
                                         Case{"alpha_1", 1, 1, 0, 1.5, 0, 256},
                                         Case{"alpha_1_dense", 1, 1, 100, 1.5, 0, 128},
                                         Case{"no_step_of_the_index", 1, 0.5, 10, 1, 0, 256},
                                         Case{"index_1_0001", 1, 0, 10, 1.0001, 0, 256},
                                         Case{"index_1_0001_rough", 1, 0.5, 10, 1.0001, 0, 256},
                                         Case{"index_4", 1, 0.2, 10, 4, 0, 512},
                                         Case{"thin_as_air", 1, 0, 1e-6, 1.5, 0, 64},
                                         Case{"a_million_mean_free_paths", 1, 0, 1e6, 1.5, 0, 128},
                                         Case{"a_million_mean_free_paths_rough", 1, 0.3, 1e6, 1.5,
                                              0, 128},
                                         Case{"denser_than_any_matter", 20, 0, 1e15, 1.5, 0, 64},
                                         Case{"forward_0_99", 1, 0, 100, 1.5, 0.99, 128},
                                         Case{"backward_0_99", 1, 0, 100, 1.5, -0.99, 64},
                                         Case{"a_micrometre", 1e-3, 0.1, 1e4, 1.5, 0, 128},
                                         Case{"a_kilometre", 1e6, 0.1, 1e-5, 1.5, 0, 128}),
                         [](const auto& hard) { return std::string(hard.param.name); });

TEST(HardCase, ASunOf34000StaysFiniteAndItsMeanIsThatOfAnotherSeed) {
  for (const double sigma_s : {0.0, 1.0, 10.0}) {
    SceneSpec spec = furnace(1, 0.2, sigma_s, 1.5, 0);
    spec.environment.source =
        ImageEnvironmentSpec{TRANSLUCUBE_SOURCE_DIR "/config/environments/sunrise.exr"};
    const Film first = trace(*build_scene(spec), 256);
    spec.seed = 2;
    const Film second = trace(*build_scene(spec), 256);
    EXPECT_EQ(first.counters.nan_samples + second.counters.nan_samples, 0u);
    const Estimate a = image_mean(first), b = image_mean(second);
    EXPECT_NEAR(a.mean, b.mean, 5 * std::hypot(a.standard_error, b.standard_error)) << sigma_s;
  }
}

TEST(HardCase, GrazingViewsOfTheSilhouetteAreUnbiased) {
  for (const double alpha : {0.0, 1e-3, 0.5}) {
    SceneSpec spec = furnace(1, alpha, 1, 1.5, 0);
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
    SceneSpec spec = furnace(1, alpha, 5, 1.5, 0);
    spec.camera.position_mm = {0.2, 0.1, 0.3};
    spec.camera.vfov_deg = 90;
    const Estimate e = image_mean(trace(*build_scene(spec), 512));
    EXPECT_NEAR(e.mean, 1, 3 * e.standard_error + 1e-4) << alpha;
    EXPECT_LT(e.standard_error, 3e-3);
  }
}

TEST(HardCase, ACameraInsideAnOpaqueBodyIsRefused) {
  SceneSpec spec = furnace(1, 0, std::numeric_limits<double>::infinity(), 1.5, 0);
  spec.camera.position_mm = {0, 0, 0.5};
  EXPECT_THROW(build_scene(spec), SceneError);
}

}  // namespace
}  // namespace translucube::test
