// Contributions developed many at a time against the operators that they are made of.

#include "renderer/film/contribution_batch.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>

#include "renderer/base/sampler.h"
#include "tests/support/absorbers.h"

namespace translucube {
namespace {

constexpr std::size_t pixels = 7;

/// Of lengths of nine decades, some never inside the body, all but full.
std::unique_ptr<ContributionBatch> random_batch() {
  auto batch = std::make_unique<ContributionBatch>();
  Rng rng(3);
  while (batch->size < ContributionBatch::capacity - 3) {
    const double length = rng.uniform() < 0.1   ? 0
                          : rng.uniform() < 0.1 ? shortest_length
                                                : std::pow(10, 9 * rng.uniform() - 5);
    const auto light = [&] { return static_cast<float>(2 * rng.uniform() - 0.5); };
    batch->push(static_cast<std::uint32_t>(rng.bits() % pixels), length, 0,
                {light(), light(), light()});
  }
  return batch;
}

std::map<std::string, Lane> lanes_of_all_kinds() {
  return {{"clear", ClearLane{}},
          {"opaque", OpaqueLane{}},
          {"rgb", RgbLane{{0.3f, 0, 20}}},
          {"spectral", make_lane(narrow_band(), 0.7)},
          {"dense", make_lane(red_glass(), 1e5)}};
}

std::vector<float> blank(std::size_t lanes = 1) {
  return std::vector<float>(lanes * pixels * pixel_floats);
}

TEST(ContributionBatch, DevelopsAsTheLaneDoes) {
  const auto batch = random_batch();
  auto developed = std::make_unique<DevelopedBatch>();
  for (const auto& [name, lane] : lanes_of_all_kinds()) {
    develop(lane, *batch, *developed);
    for (std::size_t i = 0; i < batch->size; ++i) {
      const Rgb light{batch->r[i], batch->g[i], batch->b[i]};
      const Rgb expected =
          std::visit([&](const auto& l) { return l.apply(light, batch->length[i]); }, lane);
      EXPECT_NEAR((*developed)[i].r, expected.r, 1e-6 + 1e-5 * std::fabs(expected.r)) << name;
      EXPECT_NEAR((*developed)[i].g, expected.g, 1e-6 + 1e-5 * std::fabs(expected.g)) << name;
      EXPECT_NEAR((*developed)[i].b, expected.b, 1e-6 + 1e-5 * std::fabs(expected.b)) << name;
    }
  }
}

TEST(ContributionBatch, AddsEachToItsPixel) {
  const auto batch = random_batch();
  auto developed = std::make_unique<DevelopedBatch>();
  develop(ClearLane{}, *batch, *developed);
  std::vector<float> sum = blank(), expected = blank();
  EXPECT_EQ(add(*batch, *developed, sum.data()), 0u);
  for (std::size_t i = 0; i < batch->size; ++i) {
    float* pixel = &expected[pixel_floats * batch->pixel[i]];
    pixel[0] += batch->r[i];
    pixel[1] += batch->g[i];
    pixel[2] += batch->b[i];
  }
  EXPECT_EQ(sum, expected);
}

TEST(ContributionBatch, SpreadsOverTheBinsOfTheLength) {
  const auto batch = random_batch();
  for (const BinSpread& spread : {BinSpread(), BinSpread(length_bins(100, 50))}) {
    const auto bins = static_cast<std::size_t>(spread.bins().count());
    std::vector<float> sum = blank(bins), expected = blank(bins);
    const std::size_t stride = pixels * pixel_floats;
    EXPECT_EQ(add_spread(spread, *batch, sum.data(), stride), 0u);
    for (std::size_t i = 0; i < batch->size; ++i) {
      const BinWeights found = spread(batch->length[i]);
      for (int k = 0; k < 4; ++k) {
        float* pixel = &expected[(found.bin + k) * stride + pixel_floats * batch->pixel[i]];
        pixel[0] += batch->r[i] * found.weights[k];
        pixel[1] += batch->g[i] * found.weights[k];
        pixel[2] += batch->b[i] * found.weights[k];
      }
    }
    // A length next to a node may fall on either side of it, where the cubics meet.
    for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], expected[i], 5e-4) << i;
  }
}

TEST(ContributionBatch, CountsWhatIsNotFinite) {
  const float nan = std::nanf(""), infinite = std::numeric_limits<float>::infinity();
  auto batch = std::make_unique<ContributionBatch>();
  auto developed = std::make_unique<DevelopedBatch>();
  batch->push(0, 1, 0, {1, 1, 1});
  batch->push(1, 1, 0, {1, nan, 1});
  batch->push(2, 1, 0, {1, 1, -infinite});
  for (const auto& [name, lane] : lanes_of_all_kinds()) {
    std::vector<float> sum = blank();
    develop(lane, *batch, *developed);
    const bool gone = name == "opaque";
    EXPECT_EQ(add(*batch, *developed, sum.data()), gone ? 0u : 2u) << name;
    EXPECT_TRUE(std::isfinite(sum[0])) << name;
    EXPECT_EQ(std::isnan(sum[pixel_floats + 1]), !gone) << name;
  }
  batch->push(3, nan, 0, {1, 1, 1});
  const BinSpread spread;
  std::vector<float> sum = blank(static_cast<std::size_t>(spread.bins().count()));
  EXPECT_EQ(add_spread(spread, *batch, sum.data(), pixels * pixel_floats), 3u);
  for (const float value : sum) EXPECT_TRUE(std::isfinite(value));

  batch->size = 0;
  batch->push(0, nan, 0, {1, 1, 1});
  develop(RgbLane{{1, 1, 1}}, *batch, *developed);
  EXPECT_EQ(add(*batch, *developed, sum.data()), 1u);
}

TEST(ContributionBatch, HasTheSameBitsWithAvx2AndAvx512) {
  const auto batch = random_batch();
  for (const auto& [name, lane] : lanes_of_all_kinds()) {
    std::map<std::string, std::vector<float>> sums;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().DeInit();
      auto developed = std::make_unique<DevelopedBatch>();
      const BinSpread spread;
      std::vector<float> sum = blank(static_cast<std::size_t>(spread.bins().count()));
      add_spread(spread, *batch, sum.data(), pixels * pixel_floats);
      develop(lane, *batch, *developed);
      add(*batch, *developed, sum.data());
      sums[hwy::TargetName(target)] = sum;
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().DeInit();
    }
    EXPECT_GE(sums.size(), 2u);
    if (sums.contains("AVX2") && sums.contains("AVX3")) {
      EXPECT_EQ(sums["AVX2"], sums["AVX3"]) << name;
    }
  }
}

}  // namespace
}  // namespace translucube
