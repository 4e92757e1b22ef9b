// Light found through the rough boundary of a sphere: the densities are densities, and what is
// found with them is what the walk alone finds.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "renderer/transport/sphere/rough_exits_batch.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

TEST(RoughConnections, TheDensityOfAWayIntegratesToOne) {
  // Over all directions inside, but for the ways through facets that send them up again.
  Rng rng(1);
  for (const float alpha : {0.25f, 0.6f})
    for (const double rho : {0.3, 0.9, 0.999}) {
      const Vec3 up = sample_isotropic(rng);
      const Vec3 light = normalize(up + 0.7 * sample_isotropic(rng));
      double sum = 0, squares = 0;
      int ways = 0;
      auto batch = std::make_unique<RoughWays>();
      for (int repeat = 0; repeat < 12000; ++repeat) {
        batch->size = 0;
        while (batch->size < RoughWays::capacity)
          batch->push(rho * up, 1 - rho * rho, sample_isotropic(rng), light);
        densities_of({1.5f, alpha, 1, 0}, *batch);
        for (std::size_t i = 0; i < batch->size; ++i, ++ways) {
          const double ratio = 4 * M_PI * batch->density[i];
          sum += ratio;
          squares += ratio * ratio;
        }
      }
      const double mean = sum / ways;
      const double error = std::sqrt((squares / ways - mean * mean) / ways);
      EXPECT_NEAR(mean, 1, 4 * error) << "alpha " << alpha << " rho " << rho;
      EXPECT_LT(error, 0.01);
    }
}

TEST(RoughConnections, InstructionSetsAgree) {
  auto batch = std::make_unique<RoughConnections>();
  Rng rng(2);
  while (batch->size < RoughConnections::capacity) {
    const Vec3 up = sample_isotropic(rng), light = sample_isotropic(rng), d = sample_isotropic(rng);
    const double rho = 1 - 0.5 * std::pow(rng.uniform(), 3);
    const std::size_t i = batch->push(rho * up, 1 - rho * rho, d, light);
    batch->light_pdf[i] = 0.1f;
    batch->random.start(i, rng.bits());
  }
  std::map<std::string, RoughConnections::Floats> shares;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    connect_rough({1.5f, 0.2f, 3, 0.5f}, *batch);
    shares[hwy::TargetName(target)] = batch->share;
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
  EXPECT_GE(shares.size(), 2u);
  // The same fused operations: the same request gives the same bits on both.
  if (shares.contains("AVX2") && shares.contains("AVX3")) {
    EXPECT_EQ(shares["AVX2"], shares["AVX3"]);
  }
  double sum = 0;
  for (const float share : shares.begin()->second) sum += share;
  EXPECT_GT(sum, 1);
}

/// A rough body in light from the far side, so that near and far ways out differ, or from the near
/// one.
Scene half_lit(double alpha, double sigma_s, double g, double ior, bool from_behind) {
  Scene scene = body(Sphere{}, material(ior, alpha, sigma_s, g));
  scene.environment = half_space_light(false);
  scene.lanes = {RgbLane{{0.3f, 0.3f, 0.3f}}};
  look_from_afar(scene, 0.95, 32, from_behind ? 1 : -1);
  return scene;
}

TEST(RoughConnections, FindWhatTheWalkAloneFinds) {
  std::uint64_t seed = 1;
  for (const double alpha : {0.03, 0.2, 0.8})
    for (const double sigma_s : {0.3, 4.0, 40.0}) {
      const double g = seed % 4 == 1 ? 0.7 : 0, ior = seed % 6 < 3 ? 1.2 : 2;
      Scene scene = half_lit(alpha, sigma_s, g, ior, seed % 4 < 2);
      scene.seed = ++seed;
      const Film connected = trace(scene, 128);
      light_by_a_table(scene);
      scene.seed = ++seed;
      const Film walked = trace(scene, 192);
      EXPECT_GT(connected.counters.light_samples, 0u);
      EXPECT_EQ(walked.counters.light_samples, 0u);
      const Measured a = image_mean(connected), b = image_mean(walked);
      const double error = std::hypot(a.standard_error, b.standard_error);
      EXPECT_NEAR(a.mean, b.mean, 4 * error)
          << "alpha " << alpha << " sigma_s " << sigma_s << " g " << g << " ior " << ior;
      EXPECT_LT(error, 0.02 * b.mean);
    }
}

}  // namespace
}  // namespace translucube::test
