// The truths of docs/design.md section 6 that the plain transport must meet: exact values, not our own
// output.

#include "tests/support/truths.h"

#include <gtest/gtest.h>

#include <cmath>

namespace translucube::test {
namespace {

Measured mean_path(const Material& m, std::uint32_t samples) {
  return mean_path_of(Sphere{}, m, samples);
}

// Blanco and Fournier 2003, with the factor n^2 of the radiance inside: 4 V / S n^2.
TEST(MeanPathLength, OfAScatteringSphereDoesNotDependOnDensity) {
  for (const double ior : {1.0, 1.33, 1.5, 2.5})
    for (const double sigma_s : {0.1, 1.0, 10.0}) {
      const double expected = 4.0 / 3 * ior * ior;
      const Measured path = mean_path(material(ior, 0, sigma_s), 512);
      EXPECT_NEAR(path.mean / expected, 1, 5e-3) << "ior " << ior << " sigma_s " << sigma_s;
      EXPECT_LT(path.standard_error / expected, 1.7e-3);
    }
}

TEST(MeanPathLength, OfADenseSphereIsTheSame) {
  const Measured path = mean_path(material(1.5, 0, 100), 1024);
  EXPECT_NEAR(path.mean / 3, 1, 5e-3) << path.standard_error;
  EXPECT_LT(path.standard_error / 3, 2.2e-3);
}

TEST(MeanPathLength, OfAnisotropicScatteringIsTheSame) {
  for (const double g : {-0.7, 0.8})
    EXPECT_NEAR(mean_path(material(1.5, 0, 10, g), 256).mean / 3, 1, 5e-3) << "g " << g;
}

TEST(MeanPathLength, OfAClearSmoothSphereLeavesOutTheTrappedDirections) {
  for (const double ior : {1.0, 1.33, 1.5, 2.5}) {
    const double trapped = std::pow(1 - 1 / (ior * ior), 1.5);
    const double expected = 4.0 / 3 * ior * ior * (1 - trapped);
    EXPECT_NEAR(mean_path(material(ior, 0, 0), 128).mean / expected, 1, 2e-3) << "ior " << ior;
  }
}

TEST(WidePlate, OfMatchedIndexMeetsVanDeHulst) {
  // sigma_a 10, sigma_s 90, thickness 0.02 (van de Hulst 1980, table 35).
  const LitSlab s = lit_slab(material(1, 0, 90 * 0.02, 0.75), 10 * 0.02f, 1024);
  EXPECT_NEAR(s.reflectance.mean / 0.09739, 1, 5e-3) << s.reflectance.standard_error;
  EXPECT_NEAR(s.transmittance.mean / 0.66096, 1, 5e-3) << s.transmittance.standard_error;
  EXPECT_LT(s.reflectance.standard_error / 0.09739, 1.5e-3);
}

TEST(WidePlate, ThickEnoughMeetsGiovanellisHalfSpace) {
  // Albedo 0.9, ior 1.5, normal incidence, with the specular part (Giovanelli 1955).
  constexpr double depth = 60;  // mean free paths of scattering
  const LitSlab s = lit_slab(material(1.5, 0, depth), depth / 9, 128);
  EXPECT_NEAR(s.reflectance.mean / 0.2600, 1, 5e-3) << s.reflectance.standard_error;
  EXPECT_LT(s.reflectance.standard_error / 0.26, 2e-3);
  EXPECT_LT(s.transmittance.mean, 1e-6);
}

TEST(WidePlate, ClearAndAbsorbingReflectsBetweenItsFaces) {
  const double f = 0.04, tau = 0.5;
  const LitSlab s = lit_slab(material(1.5, 0, 0), 0.5f, 256);
  const double e = std::exp(-tau), e2 = e * e;
  EXPECT_NEAR(s.transmittance.mean, (1 - f) * (1 - f) * e / (1 - f * f * e2), 1e-4);
  EXPECT_NEAR(s.reflectance.mean, f + f * (1 - f) * (1 - f) * e2 / (1 - f * f * e2), 1e-4);
}

}  // namespace
}  // namespace translucube::test
