// The oil test: where a film of matching index covers a rough body, its surface scatters no more.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/meshes.h"
#include "tests/support/truths.h"

namespace translucube::test {
namespace {

Scene oiled(AnyShape shape, const Material& m, double offset, std::uint64_t seed = 1) {
  Scene scene = body(std::move(shape), m, seed);
  scene.oiled = OiledPart{{1, 0, 0}, offset};
  return scene;
}

TEST(MeanPathLength, UnderAFilmOverHalfOfASphereIsTheSame) {
  // The film anywhere: then parallel light over the disc is diffuse light over the surface.
  constexpr int places = 200;
  for (const double sigma_s : {0.0, 2.0}) {
    double sum = 0;
    for (int i = 0; i < places; ++i) {
      Rng rng(hash_combine(11, i));
      Scene scene = path_scene(Sphere{}, material(1.5, 0.3, sigma_s), hash_combine(12, i), 16);
      scene.oiled = OiledPart{sample_isotropic(rng), 0};
      sum += over_the_disc(image_mean(trace(scene, 8)), 0).mean;
    }
    EXPECT_NEAR(sum / places / 3, 1, 0.02) << sigma_s;
  }
}

Measured under_half_a_sky(Scene scene, std::uint32_t samples) {
  scene.environment = half_space_light(true);
  look_from_afar(scene, 0.9, 24);
  return image_mean(trace(scene, samples));
}

TEST(OilFilm, OverAllOfABodyMakesItSmooth) {
  for (const double sigma_s : {0.0, 3.0, infinity}) {
    const Measured film =
        under_half_a_sky(oiled(Sphere{}, material(1.5, 0.5, sigma_s), -2, 1), 256);
    const Measured smooth = under_half_a_sky(body(Sphere{}, material(1.5, 0, sigma_s), 2), 256);
    const Measured rough = under_half_a_sky(body(Sphere{}, material(1.5, 0.5, sigma_s), 3), 256);
    const double error = std::hypot(film.standard_error, smooth.standard_error);
    EXPECT_NEAR(film.mean, smooth.mean, 4 * error + 1e-4) << sigma_s;
    if (sigma_s == 0) {
      EXPECT_GT(std::fabs(film.mean - rough.mean), 6 * error);
    }
  }
}

TEST(OilFilm, OverNothingChangesNoBit) {
  for (const double sigma_s : {0.0, infinity}) {
    const Measured film = under_half_a_sky(oiled(Sphere{}, material(1.5, 0.5, sigma_s), 2), 16);
    const Measured bare = under_half_a_sky(body(Sphere{}, material(1.5, 0.5, sigma_s)), 16);
    EXPECT_EQ(film.mean, bare.mean);
  }
}

TEST(OilFilm, LookingForLightDoesNotChangeTheMean) {
  Measured estimates[2];
  for (const bool looking : {false, true}) {
    Scene scene = oiled(Sphere{}, material(1.5, 0.4, 3), 0.1, 7 + looking);
    if (looking)
      scene.environment = half_space_light(false);
    else
      light_by_a_table(scene);
    look_from_afar(scene, 0.9, 24, -1);
    estimates[looking] = image_mean(trace(scene, 256));
  }
  const double error = std::hypot(estimates[0].standard_error, estimates[1].standard_error);
  EXPECT_NEAR(estimates[0].mean, estimates[1].mean, 4 * error);
}

}  // namespace
}  // namespace translucube::test
