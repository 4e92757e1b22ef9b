#include "renderer/optics/material_cube.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace translucube {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(MaterialCube, OriginIsTheClearSmoothEmptyBody) {
  const Coefficients c = from_cube({0, 0, 0}, 0, 10);
  EXPECT_EQ(c, (Coefficients{0, 0, 0}));
  EXPECT_FALSE(std::signbit(c.sigma_a_peak));
  EXPECT_EQ(to_cube(c, 0, 10), (CubePoint{0, 0, 0}));
}

TEST(MaterialCube, FarCornerIsInfinite) {
  const Coefficients c = from_cube({1, 1, 1}, 0.3, 10);
  EXPECT_EQ(c, (Coefficients{infinity, 1, infinity}));
  EXPECT_EQ(to_cube(c, 0.3, 10), (CubePoint{1, 1, 1}));
}

TEST(MaterialCube, AbsorptionIsTheAbsorptanceOfTheReferenceThickness) {
  // Half of the light is absorbed over 10 mm: sigma = ln 2 / 10.
  EXPECT_NEAR(from_cube({0.5, 0, 0}, 0, 10).sigma_a_peak, 0.06931471805599453, 1e-16);
  EXPECT_NEAR(from_cube({0.9, 0, 0}, 0, 1).sigma_a_peak, 2.302585092994046, 1e-14);
}

TEST(MaterialCube, RoughnessIsTheRootOfAlpha) {
  EXPECT_DOUBLE_EQ(from_cube({0, 0.3, 0}, 0, 10).alpha, 0.09);
  EXPECT_DOUBLE_EQ(to_cube({0, 0.25, 0}, 0, 10).roughness, 0.5);
}

TEST(MaterialCube, ScatteringIsTheReflectanceOfTheReferenceThickness) {
  // s = 0.5: sigma_s (1 - g) d = 4/3.
  EXPECT_DOUBLE_EQ(from_cube({0, 0, 0.5}, 0, 10).sigma_s, 4.0 / 30);
  EXPECT_DOUBLE_EQ(from_cube({0, 0, 0.5}, 0.75, 10).sigma_s, 4.0 * 4 / 30);
  EXPECT_DOUBLE_EQ(from_cube({0, 0, 0.5}, -0.5, 2).sigma_s, 4.0 / 9);
}

TEST(MaterialCube, InverseOfTheLawsIsTheIdentity) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1), cosine(-0.999, 0.999), exponent(-6, 6);
  for (int i = 0; i < 10000; ++i) {
    const CubePoint point{unit(random), unit(random), unit(random)};
    const double g = cosine(random), d = std::pow(10, exponent(random));
    const CubePoint back = to_cube(from_cube(point, g, d), g, d);
    ASSERT_NEAR(back.absorption, point.absorption, 1e-15);
    ASSERT_NEAR(back.roughness, point.roughness, 1e-15);
    ASSERT_NEAR(back.scattering, point.scattering, 1e-15);
  }
}

TEST(MaterialCube, BothEndsKeepTheirDigits) {
  for (const double tiny : {1e-300, 1e-30, 1e-16, 1e-9}) {
    const CubePoint low = to_cube(from_cube({tiny, 0, tiny}, 0, 10), 0, 10);
    EXPECT_NEAR(low.absorption / tiny, 1, 1e-14);
    EXPECT_NEAR(low.scattering / tiny, 1, 1e-14);
  }
  for (const double gap : {0x1p-53, 0x1p-50, 0x1p-30}) {
    const CubePoint high{1 - gap, 0, 1 - gap};
    const Coefficients c = from_cube(high, 0, 10);
    EXPECT_TRUE(std::isfinite(c.sigma_a_peak));
    EXPECT_TRUE(std::isfinite(c.sigma_s));
    // The nearest double to 1 - gap or its neighbour.
    EXPECT_NEAR(to_cube(c, 0, 10).absorption, high.absorption, 0x1p-53);
    EXPECT_NEAR(to_cube(c, 0, 10).scattering, high.scattering, 0x1p-53);
  }
}

TEST(MaterialCube, CoordinatesRiseWithTheirCoefficients) {
  CubePoint last{-1, -1, -1};
  for (double sigma = 1e-12; sigma < 1e12; sigma *= 1.1) {
    const CubePoint point = to_cube({sigma, std::min(1.0, sigma), sigma}, 0.5, 10);
    ASSERT_GE(point.absorption, last.absorption);
    ASSERT_GE(point.roughness, last.roughness);
    ASSERT_GE(point.scattering, last.scattering);
    ASSERT_LE(point.absorption, 1);
    ASSERT_LE(point.scattering, 1);
    last = point;
  }
}

TEST(DerivedOptics, EmptyBodyHasNoEvent) {
  const DerivedOptics optics = derived_optics({0, 0.1, 0}, 0.5);
  EXPECT_EQ(optics.mean_free_path_mm, infinity);
  EXPECT_EQ(optics.transport_mean_free_path_mm, infinity);
  EXPECT_EQ(optics.albedo_at_peak, 0);
}

TEST(DerivedOptics, FollowFromTheCoefficients) {
  const DerivedOptics optics = derived_optics({1, 0, 4}, 0.75);
  EXPECT_DOUBLE_EQ(optics.mean_free_path_mm, 0.2);
  EXPECT_DOUBLE_EQ(optics.transport_mean_free_path_mm, 0.5);
  EXPECT_DOUBLE_EQ(optics.albedo_at_peak, 0.8);
}

TEST(DerivedOptics, InfiniteScattererIsWhiteAndInfiniteAbsorberIsBlack) {
  EXPECT_EQ(derived_optics({5, 0, infinity}, 0).albedo_at_peak, 1);
  EXPECT_EQ(derived_optics({infinity, 0, 5}, 0).albedo_at_peak, 0);
  EXPECT_EQ(derived_optics({infinity, 0, infinity}, 0).albedo_at_peak, 0);
  EXPECT_EQ(derived_optics({infinity, 0, infinity}, 0).mean_free_path_mm, 0);
}

}  // namespace
}  // namespace translucube
