// The oil test: where a film of matching index covers a rough body, its surface scatters no more.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/meshes.h"
#include "tests/support/truths.h"

namespace translucube::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Scene oiled(Shape shape, const Material& m, double offset, std::uint64_t seed = 1) {
  Scene scene = body(std::move(shape), m, seed);
  scene.oiled = OiledPart{{1, 0, 0}, offset};
  return scene;
}

TEST(WhiteFurnace, AHalfOiledBodyVanishes) {
  const Shape shapes[] = {Sphere{}, make_box({0.6, 0.5, 0.2}), Bowl(0.8),
                          build_mesh(icosphere(3)).mesh};
  for (const Shape& shape : shapes)
    for (const Material& m : {material(1.5, 0.3, 0), material(1.5, 0.3, 4), material(1.33, 1, 50),
                              material(1.5, 0.3, infinity)}) {
      Scene scene = oiled(shape, m, 0);
      scene.width = scene.height = 24;
      scene.camera = Camera({0.8, 1.2, 3}, {0, 0, 0}, {0, 1, 0}, 32, 24, 24);
      const Film film = trace(scene, 128);
      const Estimate e = image_mean(film);
      EXPECT_NEAR(e.mean, 1, 2e-3)
          << shape.index() << " sigma_s " << m.coefficients.sigma_s << " +- " << e.standard_error;
      EXPECT_LT(e.standard_error, 8e-4);
      EXPECT_LT(film.counters.truncated_energy / double(film.counters.camera_samples), 1e-5);
    }
}

TEST(MeanPathLength, UnderAFilmOverHalfOfASphereIsTheSame) {
  for (const double sigma_s : {0.0, 2.0}) {
    Scene scene = path_scene(Sphere{}, material(1.5, 0.3, sigma_s));
    scene.oiled = OiledPart{{0.6, 0, 0.8}, 0};
    EXPECT_NEAR(over_the_disc(image_mean(trace(scene, 512)), 0).mean / 3, 1, 1e-2) << sigma_s;
  }
}

Estimate under_half_a_sky(Scene scene, std::uint32_t samples) {
  scene.environment = half_space_light(true);
  look_from_afar(scene, 0.9, 24);
  return image_mean(trace(scene, samples));
}

TEST(OilFilm, OverAllOfABodyMakesItSmooth) {
  for (const double sigma_s : {0.0, 3.0, infinity}) {
    const Estimate film =
        under_half_a_sky(oiled(Sphere{}, material(1.5, 0.5, sigma_s), -2, 1), 1024);
    const Estimate smooth = under_half_a_sky(body(Sphere{}, material(1.5, 0, sigma_s), 2), 1024);
    const Estimate rough = under_half_a_sky(body(Sphere{}, material(1.5, 0.5, sigma_s), 3), 1024);
    const double error = std::hypot(film.standard_error, smooth.standard_error);
    EXPECT_NEAR(film.mean, smooth.mean, 4 * error + 1e-4) << sigma_s;
    if (sigma_s == 0) {
      EXPECT_GT(std::fabs(film.mean - rough.mean), 10 * error);
    }
  }
}

TEST(OilFilm, OverNothingChangesNoBit) {
  for (const double sigma_s : {0.0, infinity}) {
    const Estimate film = under_half_a_sky(oiled(Sphere{}, material(1.5, 0.5, sigma_s), 2), 16);
    const Estimate bare = under_half_a_sky(body(Sphere{}, material(1.5, 0.5, sigma_s)), 16);
    EXPECT_EQ(film.mean, bare.mean);
  }
}

TEST(OilFilm, LookingForLightDoesNotChangeTheMean) {
  Estimate estimates[2];
  for (const bool looking : {false, true}) {
    Scene scene = oiled(Sphere{}, material(1.5, 0.4, 3), 0.1, 7 + looking);
    scene.next_event_estimation = looking;
    estimates[looking] = under_half_a_sky(std::move(scene), 1024);
  }
  const double error = std::hypot(estimates[0].standard_error, estimates[1].standard_error);
  EXPECT_NEAR(estimates[0].mean, estimates[1].mean, 4 * error);
}

}  // namespace
}  // namespace translucube::test
