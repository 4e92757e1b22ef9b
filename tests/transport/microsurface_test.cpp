// Multiple scattering between microfacets: no energy lost, reciprocity, and the single scattering
// of other renderers as its first term.

#include "renderer/optics/microsurface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/microsurface.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

TEST(Microsurface, ReflectsAndTransmitsAllLight) {
  for (const double alpha : {1e-4, 0.05, 0.3, 1.0})
    for (const double ior : {1.0001, 1.33, 1.5, 2.5})
      for (const double eta : {ior, 1 / ior})
        for (const double mu : {1.0, 0.6, 0.1, 1e-3}) {
          const DirectionalAlbedo a = directional_albedo({ior, Ggx{alpha}, true}, eta, mu);
          EXPECT_NEAR(a.reflected + a.transmitted, 1, 1e-4) << alpha << " " << eta << " " << mu;
        }
}

// What single-scattering GGX keeps, by Mitsuba 0.6 and pbrt-v4 (which differ by up
// to .03 in their shadowing of transmission).
TEST(WhiteFurnace, ARoughBodyKeepsWhatSingleScatteringKeeps) {
  const std::pair<double, double> kept[] = {
      {.05, .983}, {.1, .945}, {.25, .787}, {.5, .556}, {1, .305}};
  for (const auto& [alpha, expected] : kept) {
    Scene scene = body(Sphere{}, material(1.5, alpha, 0));
    std::get<RoughInterface>(scene.interface).multiple_scattering = false;
    look_from_afar(scene, 1.0, 64);
    const double covered = std::numbers::pi / 4;
    const Measured e = image_mean(trace(scene, 64));
    EXPECT_NEAR((e.mean - (1 - covered)) / covered, expected, 0.03) << "alpha " << alpha;
  }
}

TEST(Microsurface, IsReciprocalInReflectionAndTransmission) {
  // f(wi -> wo) / eta_o^2 = f(wo -> wi) / eta_i^2; basic radiance divides by the light's side
  // already.
  for (const double alpha : {0.2, 0.6, 1.0})
    for (const double ior : {1.5, 1 / 1.5}) {
      const Vec3 a = from_angles(0.8, 0), b = from_angles(0.35, 2.0);
      const Measured forth = bsdf(Ggx{alpha}, ior, a, b, 1), back = bsdf(Ggx{alpha}, ior, b, a, 2);
      EXPECT_NEAR(forth.mean, back.mean,
                  4.5 * std::hypot(forth.standard_error, back.standard_error))
          << "reflection, alpha " << alpha;
      EXPECT_LT(forth.standard_error, 0.03 * forth.mean);

      const Vec3 below = from_angles(0.5, 2.6), mirrored_a{a.x, a.y, -a.z};
      const Vec3 wi{below.x, below.y, -below.z};
      const Measured down = bsdf(Ggx{alpha}, ior, a, wi, 3);
      const Measured up = bsdf(Ggx{alpha}, 1 / ior, below, mirrored_a, 4);
      // From a's side eta_i = ior: f_basic(a, wi) / eta_i^2 = f_basic(wi, a).
      const double scale = ior * ior;
      EXPECT_NEAR(down.mean / scale, up.mean,
                  4.5 * std::hypot(down.standard_error / scale, up.standard_error))
          << "transmission, alpha " << alpha << " ior " << ior;
      EXPECT_LT(down.standard_error, 0.1 * down.mean);
    }
}

TEST(Microsurface, TendsToTheSmoothInterface) {
  for (const double mu : {1.0, 0.5, 0.1})
    for (const double eta : {1.5, 1 / 1.5}) {
      const DirectionalAlbedo a = directional_albedo({1.5, Ggx{1e-4}, true}, eta, mu);
      EXPECT_NEAR(a.reflected, fresnel(mu, eta), 2e-3) << mu << " " << eta;
    }
}

TEST(Microsurface, OfNoStepInTheIndexLetsAllLightThrough) {
  for (const double alpha : {0.1, 1.0}) {
    const DirectionalAlbedo a = directional_albedo({1.0001, Ggx{alpha}, true}, 1.0001, 0.5);
    EXPECT_NEAR(a.transmitted, 1, 1e-3);
  }
}

}  // namespace
}  // namespace translucube::test
