// Absorption developed from bins of path length against the exact operators.

#include "renderer/film/absorption.h"
#include "renderer/film/length_bins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "renderer/base/half.h"
#include "tests/support/absorbers.h"

namespace translucube {
namespace {

double largest_difference(Rgb p, Rgb q) {
  return std::max({std::fabs(p.r - q.r), std::fabs(p.g - q.g), std::fabs(p.b - q.b)});
}

Rgb apply(const Lane& lane, double length) {
  return std::visit([&](const auto& l) { return l.apply(Rgb{1, 1, 1}, length); }, lane);
}

/// White light of one length, developed from the bins.
Rgb apply_spread(const Lane& lane, const BinSpread& spread, double length) {
  const BinWeights s = spread(length);
  Rgb sum;
  for (int i = 0; i < 4; ++i) sum += apply(lane, spread.bins().length(s.bin + i)) * s.weights[i];
  return sum;
}

/// Over lengths in geometric progression.
SpreadError spread_error(const Lane& lane, const BinSpread& spread, double from, double to) {
  SpreadError error;
  constexpr int count = 3000;
  for (int i = 0; i < count; ++i) {
    const double length = from * std::pow(to / from, (i + 0.5) / count);
    const double e = largest_difference(apply_spread(lane, spread, length), apply(lane, length));
    error.largest = std::max(error.largest, e);
    error.mean += e / count;
  }
  return error;
}

TEST(LengthBins, WeightsOfEveryLengthAddUpToOne) {
  const BinSpread spread;
  for (double length = 1e-9; length < 1e6; length *= 1.01) {
    const BinWeights s = spread(length);
    EXPECT_NEAR(std::accumulate(s.weights.begin(), s.weights.end(), 0.0), 1, 2e-7) << length;
    EXPECT_GE(s.bin, 1);
    EXPECT_LE(s.bin + 3, spread.bins().count() - 1);
  }
}

TEST(LengthBins, WhatIsNeverInsideHasABinOfItsOwn) {
  const BinSpread spread;
  EXPECT_EQ(spread(0).bin, 0);
  EXPECT_EQ(spread(0).weights, (std::array<float, 4>{1, 0, 0, 0}));
  EXPECT_EQ(spread(shortest_length).bin, 1);
  EXPECT_EQ(spread(shortest_length).weights, (std::array<float, 4>{1, 0, 0, 0}));
}

TEST(LengthBins, LengthsAtTheNodesGoToThemAlone) {
  const BinSpread spread;
  for (int bin = LengthBins::before_nodes; bin < spread.bins().count(); ++bin) {
    const BinWeights s = spread(spread.bins().length(bin));
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(s.weights[i], s.bin + i == bin ? 1 : 0, 1e-4) << bin << ' ' << i;
  }
}

TEST(LengthBins, EveryAbsorberStaysWithinAThousandthBetweenTheNodes) {
  const BinSpread spread;
  double mean = 0;
  int count = 0;
  for (double sigma = 1e-4; sigma <= 1e4; sigma *= 1.3)
    for (const Absorber& absorber :
         {Absorber{plain_rgb()}, Absorber{narrow_band()}, Absorber{red_glass()}}) {
      const SpreadError error = spread_error(make_lane(absorber, sigma), spread, 0.003, 300);
      EXPECT_LT(error.largest, 9e-4) << sigma;  // 6e-4 but in the first and the last interval
      mean += error.mean;
      ++count;
    }
  // Most light is far from where the error peaks.
  EXPECT_LT(mean / count, 1e-4);
  std::printf("mean error over lengths and absorbers %.2g\n", mean / count);
}

TEST(LengthBins, LengthsBelowTheFirstNodeStayWithinAThousandthUpToTheDensestAbsorption) {
  for (const double densest : {1.0, 50.0, 130.0, 1e3, 3e5}) {
    const BinSpread spread(length_bins(densest, 1e9));
    for (const double share : {1e-3, 0.03, 0.3, 1.0})
      for (const Absorber& absorber : {Absorber{plain_rgb()}, Absorber{narrow_band()}})
        EXPECT_LT(
            spread_error(make_lane(absorber, densest * share), spread, 1e-12, spread.bins().first)
                .largest,
            1e-3)
            << densest << ' ' << share;
  }
}

TEST(LengthBins, AreThirtyTwoNodesUnlessTheBodyIsLargeOrDense) {
  EXPECT_EQ(length_bins(74, 2.7), LengthBins{});
  EXPECT_EQ(length_bins(74, 0), LengthBins{});
  EXPECT_EQ(length_bins(0, 0), LengthBins{});
  // Without scattering no light turns back early, so nothing is shorter than the body.
  EXPECT_EQ(length_bins(1e5, 0), LengthBins{});
  const LengthBins dense = length_bins(1e4, 1e3);
  EXPECT_LE(dense.first, 4e-5);
  EXPECT_GE(dense.last, 3000);
  EXPECT_NEAR(dense.step(), LengthBins{}.step(), 1e-12);
  for (const double extreme : {1e-300, 1e300, std::numeric_limits<double>::infinity()})
    for (const double scattering : {0.0, 1e-300, 1e300, std::numeric_limits<double>::infinity()})
      EXPECT_LE(length_bins(extreme, scattering).count(), 140);
}

TEST(HalfFloats, ReadBackWhatTheyHold) {
  for (std::uint32_t h = 0; h < 0x7c00; ++h) {
    EXPECT_EQ(float_to_half(half_to_float(static_cast<std::uint16_t>(h))), h);
    EXPECT_EQ(half_to_float(static_cast<std::uint16_t>(h | 0x8000)),
              -half_to_float(static_cast<std::uint16_t>(h)));
  }
  EXPECT_EQ(half_to_float(0x3c00), 1.0f);
  EXPECT_EQ(half_to_float(0x7bff), 65504.0f);
  EXPECT_EQ(half_to_float(0x0001), 0x1p-24f);
}

TEST(HalfFloats, RoundToTheNearest) {
  for (float value = 1e-7f; value < 6e4f; value *= 1.0137f) {
    const float error = std::fabs(half_to_float(float_to_half(-value)) + value);
    EXPECT_LE(error, std::max(value * 0x1p-11f, 0x1p-25f)) << value;
  }
}

}  // namespace
}  // namespace translucube
