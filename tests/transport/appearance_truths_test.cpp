// Slab optics against what is known in closed form or from the literature. Every comparison states
// the standard error that the answer itself claims; a claim that is too small fails StandardErrors.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderer/optics/fresnel.h"
#include "renderer/optics/lambertian.h"
#include "renderer/optics/microsurface.h"
#include "tests/support/slabs.h"

namespace translucube::test {
namespace {

/// int_1^inf exp(-x t) t^-n dt by Simpson's rule in u = 1/t, u^(n-2) exp(-x/u).
double exponential_integral(int n, double x) {
  constexpr int steps = 20'000;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double u = static_cast<double>(i) / steps;
    const double f = i == 0 ? 0 : std::pow(u, n - 2) * std::exp(-x / u);
    sum += f * (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2);
  }
  return sum / (3 * steps);
}

// ---- what is known in closed form

TEST(ClearPlate, ReflectsBetweenItsFacesExactly) {
  for (const double tau : {0.0, 0.5, 3.0})
    for (const double ior : {1.0, 1.01, 1.5, 2.5}) {
      const SlabAppearance s = measure(plate(ior, 0, 0, tau));
      const double f = std::pow((ior - 1) / (ior + 1), 2), e = std::exp(-tau);
      const double t = (1 - f) * (1 - f) * e / (1 - f * f * e * e);
      EXPECT_NEAR(s.normal.value.transmitted.direct[0], t, 1e-14);
      EXPECT_NEAR(s.normal.value.transmitted.total[2], t, 1e-14);
      EXPECT_NEAR(s.normal.value.reflected.direct[1], f + f * e * t, 1e-14);
      EXPECT_EQ(s.normal.value.transmitted.diffuse[1], 0);
      EXPECT_EQ(s.normal.value.reflected.diffuse[1], 0);
      EXPECT_EQ(s.largest_standard_error, 0);
      EXPECT_EQ(s.samples, 0u);
      EXPECT_EQ(s.transport, "clear");
      ASSERT_TRUE(s.haze && s.clarity);
      EXPECT_EQ(s.haze->value, 0);
      EXPECT_EQ(s.clarity->value, 1);
    }
}

TEST(ClearPlate, OfMatchedIndexTransmitsTheExponentialIntegral) {
  for (const double tau : {0.01, 0.3, 1.0, 4.0}) {
    const SlabAppearance s = measure(plate(1, 0, 0, tau));
    EXPECT_NEAR(transmittance(s.normal), std::exp(-tau), 1e-14);
    EXPECT_NEAR(transmittance(s.diffuse) / (2 * exponential_integral(3, tau)), 1, 1e-8) << tau;
    EXPECT_EQ(reflectance(s.diffuse), 0);
  }
}

TEST(ClearPlate, ReflectsDiffuseLightAsStokesDoes) {
  // No absorption: 2 F / (1 + F) (Stokes 1862), averaged here by the midpoint rule.
  double expected = 0;
  constexpr int n = 200'000;
  for (int i = 0; i < n; ++i) {
    const double mu = (i + 0.5) / n, f = fresnel(mu, 1.5);
    expected += 2 * mu / n * 2 * f / (1 + f);
  }
  const SlabAppearance s = measure(plate(1.5, 0, 0));
  EXPECT_NEAR(reflectance(s.diffuse), expected, 1e-8);
  EXPECT_NEAR(transmittance(s.diffuse), 1 - expected, 1e-8);
}

TEST(BlackBody, ReflectsAtItsInterfaceOnly) {
  Material m = plate(1.5, 0, 3, INFINITY);
  const SlabAppearance s = measure(m);
  EXPECT_NEAR(reflectance(s.normal), 0.04, 1e-14);
  EXPECT_NEAR(reflectance(s.diffuse), diffuse_fresnel_outside(1.5), 1e-6);
  EXPECT_EQ(transmittance(s.normal), 0);
  EXPECT_FALSE(s.haze) << "nothing is transmitted";
  EXPECT_FALSE(s.clarity);
  EXPECT_EQ(s.transport, "interface");

  m.coefficients.alpha = 0.5;
  const SlabAppearance rough = measure(m);
  EXPECT_EQ(transmittance(rough.diffuse), 0);
  const RoughInterface interface {
    1.5, Ggx { 0.5 }
  };
  EXPECT_NEAR(reflectance(rough.normal), directional_albedo(interface, 1.5, 1).reflected,
              4 * reflectance_error(rough.normal) + 2e-4);
}

TEST(InfinitelyDenseBody, ReflectsAll) {
  for (const double alpha : {0.0, 0.5}) {
    const SlabAppearance s = measure(plate(1.5, alpha, INFINITY, 0.2));
    for (const auto* at : {&s.normal, &s.diffuse}) {
      EXPECT_EQ(reflectance(*at), 1);
      EXPECT_EQ(transmittance(*at), 0);
    }
    EXPECT_NEAR(s.normal.value.reflected.direct[0], alpha == 0 ? 0.04 : 0, 1e-14);
    EXPECT_NEAR(s.normal.value.reflected.lab[0], 100, 1e-9);
    EXPECT_EQ(s.transport, "interfaced-lambertian");
  }
}

// ---- what is known from the literature

TEST(ScatteringSlab, MeetsVanDeHulst) {
  // sigma_a 10, sigma_s 90, g 0.75, thickness 0.02 (van de Hulst 1980, table 35).
  Material m = plate(1, 0, 90, 10, 0.75);
  const SlabAppearance s = slab_appearance(m, 0.02, 7e-5, 1, 0);
  EXPECT_NEAR(reflectance(s.normal) / 0.09739, 1, 2e-3) << reflectance_error(s.normal);
  EXPECT_NEAR(transmittance(s.normal) / 0.66096, 1, 2e-3) << transmittance_error(s.normal);
  EXPECT_LT(reflectance_error(s.normal) / 0.09739, 8e-4);
  EXPECT_NEAR(s.normal.value.transmitted.direct[0], std::exp(-2.0), 1e-14);
  EXPECT_EQ(s.normal.value.reflected.direct[0], 0);
}

TEST(ScatteringSlab, ThickEnoughMeetsGiovanellisHalfSpace) {
  // Albedo 0.9, ior 1.5, with the specular part (Giovanelli 1955): 0.2600 at normal incidence.
  const SlabAppearance s = measure(plate(1.5, 0, 90, 10), 1.5e-4);
  EXPECT_NEAR(reflectance(s.normal) / 0.2600, 1, 2e-3) << reflectance_error(s.normal);
  EXPECT_NEAR(s.normal.value.reflected.direct[1], 0.04, 1e-14);
  EXPECT_LT(transmittance(s.normal), 1e-6);
}

// ---- pigments: the scatterers absorb

Material pigment_plate(double alpha, double sigma_s, double ratio, double g = 0) {
  Material m = plate(1.5, alpha, sigma_s, ratio == 0 ? 0 : ratio * sigma_s, g);
  m.absorption_per_scattering = ratio;
  return m;
}

TEST(PigmentSlab, IsTheSlabOfItsCoefficients) {
  for (const double sigma_s : {0.0, 2.0, 30.0}) {
    Material pigment = pigment_plate(0.2, sigma_s, 0.05), same = plate(1.5, 0.2, sigma_s);
    pigment.absorber = same.absorber = SpectralAbsorber{{400, 500, 700}, {0.2, 1, 0.1}};
    same.coefficients.sigma_a_peak = 0.05 * sigma_s;
    const SlabAppearance a = measure(pigment, 5e-3), b = measure(same, 5e-3);
    EXPECT_EQ(a.normal.value.reflected.total, b.normal.value.reflected.total);
    EXPECT_EQ(a.diffuse.value.transmitted.bands, b.diffuse.value.transmitted.bands);
  }
}

TEST(PigmentSlab, OfInfiniteDensityIsGiovanellisHalfSpace) {
  for (const double thickness_mm : {1e-3, 1.0, 1e3}) {
    const Material m = pigment_plate(0, INFINITY, 1.0 / 9);
    const SlabAppearance s = slab_appearance(m, thickness_mm, 1.5e-4, 1, 0);
    EXPECT_NEAR(reflectance(s.normal) / 0.2600, 1, 2e-3) << reflectance_error(s.normal);
    EXPECT_NEAR(s.normal.value.reflected.direct[1], 0.04, 1e-14);
    EXPECT_LT(transmittance(s.diffuse), 1e-6);
  }
}

TEST(PigmentSlab, TendsToItsDenseLimit) {
  for (const double alpha : {0.0, 0.3})
    for (const double g : {0.0, 0.9}) {
      // To 1e-3 although the absorption is slight: the diffusion length is 18 / (1 - g).
      const SlabAppearance limit = measure(pigment_plate(alpha, INFINITY, 1e-3 * (1 - g), g));
      const SlabAppearance dense = measure(pigment_plate(alpha, 1e4, 1e-3 * (1 - g), g), 1e-3, 2);
      EXPECT_NEAR(
          reflectance(dense.diffuse), reflectance(limit.diffuse),
          4 * std::hypot(reflectance_error(dense.diffuse), reflectance_error(limit.diffuse)) +
              1e-6);
      EXPECT_GT(reflectance(limit.diffuse), 0.7);
      EXPECT_LT(reflectance(limit.diffuse), 0.95);
    }
}

TEST(PigmentSlab, ThatDoesNotAbsorbIsWhite) {
  EXPECT_EQ(reflectance(measure(pigment_plate(0, INFINITY, 0)).normal), 1);
}

}  // namespace
}  // namespace translucube::test
