// Pigments: one density for scatterers and absorbers. As it grows the body becomes opaque and
// coloured, neither black nor white (Gerardin et al. 2019, figure 7).

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

Material pigment(double ior, double alpha, double sigma_s, double ratio) {
  Material m = material(ior, alpha, sigma_s);
  m.absorption_per_scattering = ratio;
  m.coefficients.sigma_a_peak = ratio * sigma_s;
  m.absorber = RgbAbsorber{{1, 1, 1}};
  return m;
}

/// Mean over the body of a sphere in the white furnace.
Measured mean_radiance(const Material& m, std::uint32_t samples) {
  Scene scene = body(Sphere{}, m);
  scene.lanes = {make_lane(m, scene.interior, 1.0)};
  look_from_afar(scene, 0.7, 32);
  return image_mean(trace(scene, samples));
}

TEST(Pigment, OfInfiniteDensityIsGiovanellisHalfSpace) {
  // Albedo 0.9, ior 1.5, normal incidence: 0.2600 with the specular part (Giovanelli 1955).
  const Material m = pigment(1.5, 0, infinity, 1.0 / 9);
  Scene scene = body(Sphere{}, m);
  scene.lanes = {make_lane(m, scene.interior, 1.0)};
  look_from_afar(scene, 0.01, 32);
  const Measured e = image_mean(trace(scene, 2048));
  EXPECT_NEAR(e.mean / 0.26, 1, 5e-3) << e.standard_error;
  EXPECT_LT(e.standard_error / 0.26, 1.7e-3);
}

TEST(Pigment, TendsToItsDenseLimitWithoutAJump) {
  for (const double alpha : {0.0, 0.3}) {
    const Measured limit = mean_radiance(pigment(1.5, alpha, infinity, 0.05), 512);
    const Measured dense = mean_radiance(pigment(1.5, alpha, 3000, 0.05), 512);
    EXPECT_NEAR(dense.mean, limit.mean,
                4 * std::hypot(dense.standard_error, limit.standard_error) + 1e-3);
    EXPECT_GT(limit.mean, 0.2);
    EXPECT_LT(limit.mean, 0.9);
  }
}

TEST(Pigment, ThatDoesNotAbsorbIsWhite) {
  const Measured e = mean_radiance(pigment(1.5, 0, infinity, 0), 512);
  EXPECT_NEAR(e.mean, 1, 1e-3) << e.standard_error;
}

TEST(Pigment, OfNoDensityIsClear) {
  EXPECT_NEAR(mean_radiance(pigment(1.5, 0, 0, 0.5), 64).mean, 1, 1e-3);
}

}  // namespace
}  // namespace translucube::test
