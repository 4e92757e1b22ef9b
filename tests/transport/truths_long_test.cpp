// The long forms of the truths of docs/design.md section 6: 0.2 % at four standard errors.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "renderer/slab/appearance.h"
#include "tests/support/truths.h"

namespace translucube::test {
namespace {

constexpr double tolerance = 2e-3, largest_error = 5e-4;  // relative

/// Traces until the image's mean is known to a relative standard error.
Measured known_mean(Scene scene, double expected) {
  Measured pooled;
  double weight = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    scene.seed = seed;
    const Measured e = image_mean(trace(scene, 512));
    pooled.mean += (e.mean - pooled.mean) / seed;
    weight += e.standard_error * e.standard_error;
    pooled.standard_error = std::sqrt(weight) / seed;
    if (seed >= 2 && pooled.standard_error <= largest_error * expected) break;
  }
  return pooled;
}

void expect_truth(const Scene& scene, double expected, const std::string& what) {
  const Measured e = known_mean(scene, expected);
  EXPECT_NEAR(e.mean / expected, 1, tolerance) << what << " +- " << e.standard_error / expected;
  EXPECT_LE(e.standard_error / expected, largest_error) << what;
}

TEST(LongWidePlate, OfMatchedIndexMeetsVanDeHulst) {
  const Material m = material(1, 0, 90 * 0.02, 0.75);
  expect_truth(lit_slab_scene(m, 10 * 0.02f, true), 0.09739, "reflectance");
  expect_truth(lit_slab_scene(m, 10 * 0.02f, false), 0.66096, "transmittance");
}

// 0.2600 has four digits: its rounding of 0.02 % is a tenth of the tolerance.
TEST(LongWidePlate, ThickEnoughMeetsGiovanellisHalfSpace) {
  constexpr float depth = 60;  // mean free paths of scattering
  expect_truth(lit_slab_scene(material(1.5, 0, depth), depth / 9, true), 0.2600, "reflectance");
}

TEST(LongSlab, OpticsFromTheLightsSideMeetBoth) {
  Material m;
  m.coefficients = {10, 0, 90};
  m.g = 0.75;
  m.ior = 1;
  const SlabAppearance hulst = slab_appearance(m, 0.02, 0.09739 * largest_error, 1, 0);
  EXPECT_NEAR(hulst.normal.value.reflected.total[1] / 0.09739, 1, tolerance);
  EXPECT_NEAR(hulst.normal.value.transmitted.total[1] / 0.66096, 1, tolerance);
  m.g = 0;
  m.ior = 1.5;
  const SlabAppearance half_space = slab_appearance(m, 1, 0.26 * largest_error, 1, 0);
  EXPECT_NEAR(half_space.normal.value.reflected.total[1] / 0.2600, 1, tolerance);
}

// Blanco and Fournier 2003: 4 V / S n^2.
TEST(LongMeanPathLength, OfAScatteringSphereIsExact) {
  for (const double ior : {1.0, 1.33, 1.5, 2.5})
    for (const double sigma_s : {0.1, 1.0, 10.0}) {
      std::ostringstream what;
      what << "ior " << ior << " sigma_s " << sigma_s;
      expect_truth(path_scene(Sphere{}, material(ior, 0, sigma_s)), disc * 4.0 / 3 * ior * ior,
                   what.str());
    }
}

}  // namespace
}  // namespace translucube::test
