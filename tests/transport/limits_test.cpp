// The edges of the cube are limits: no coordinate jumps as it reaches its end, none as it leaves
// its start.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

/// Half of the light on the side of the camera, so that what is reflected and what is transmitted
/// differ.
struct Look {
  double absorption = 0, alpha = 0, sigma_s = 0, ior = 1.5;
};
Measured look(const Look& l, std::uint32_t samples = 512) {
  Material m = material(l.ior, l.alpha, l.sigma_s);
  m.coefficients.sigma_a_peak = l.absorption;
  m.absorber = RgbAbsorber{{1, 1, 1}};
  Scene scene = body(Sphere{}, m);
  scene.environment = half_space_light(true);
  scene.lanes = {make_lane(m, scene.interior, 1.0)};
  look_from_afar(scene, 1.05, 32);
  return image_mean(trace(scene, samples));
}

void expect_near(const Measured& a, const Measured& b, double step, const std::string& what) {
  const double error = std::hypot(a.standard_error, b.standard_error);
  EXPECT_NEAR(a.mean, b.mean, step + 4 * error) << what;
  EXPECT_LT(error, 5e-3) << what;
}

TEST(Limit, OfInfiniteAbsorptionIsTheBlackBody) {
  for (const double alpha : {0.0, 0.3})
    for (const double sigma_s : {0.0, 3.0})
      expect_near(look({1e5, alpha, sigma_s}), look({infinity, alpha, sigma_s}), 1e-3,
                  "absorption");
}

TEST(Limit, OfInfiniteScatteringIsTheInterfacedLambertianBody) {
  // Not quite: what a dense half space emits follows Chandrasekhar's H, not Lambert's law, so the
  // picture keeps a difference of about a hundredth of the white that no density removes; its
  // energy is the same.
  for (const double alpha : {0.0, 0.3})
    expect_near(look({0, alpha, 1e5}), look({0, alpha, infinity}), 0.01, "scattering");
}

TEST(Limit, OfNoRoughnessIsTheSmoothInterface) {
  for (const double sigma_s : {0.0, 3.0})
    expect_near(look({0, 1e-4, sigma_s}), look({0, 0, sigma_s}), 1e-3, "roughness");
}

TEST(Limit, OfNoStepOfTheIndexIsNothingThere) {
  for (const double alpha : {0.0, 0.5})
    for (const double sigma_s : {0.0, 3.0})
      expect_near(look({0, alpha, sigma_s, 1.0001}), look({0, alpha, sigma_s, 1}), 2e-3, "index");
}

TEST(Limit, OfTheFirstStepOffEveryAxisIsTheAxis) {
  const Measured clear = look({});
  expect_near(look({1e-4, 0, 0}), clear, 1e-3, "absorption");
  expect_near(look({0, 1e-4, 0}), clear, 1e-3, "roughness");
  expect_near(look({0, 0, 1e-4}), clear, 1e-3, "scattering");
}

TEST(Limit, BetweenNoAndSomeScatteringUnderARoughInterfaceHasNoJump) {
  expect_near(look({0, 0.3, 1e-4}), look({0, 0.3, 0}), 1e-3, "scattering");
}

TEST(Limit, OfTheLeastRoughnessIsSmooth) {
  EXPECT_TRUE(std::holds_alternative<SmoothInterface>(make_interface(material(1.5, 1e-38, 4))));
  EXPECT_TRUE(std::holds_alternative<SmoothInterface>(make_interface(material(1.5, 9e-7, 4))));
  const Material m = material(1.5, least_alpha, 4);
  ASSERT_TRUE(std::holds_alternative<RoughInterface>(make_interface(m)));
  for (const AnyShape& shape : {AnyShape(Sphere{}), AnyShape(make_box({0.5, 0.6, 0.6}))}) {
    Scene rough = body(shape, m), smooth = body(shape, material(1.5, 0, 4));
    for (Scene* scene : {&rough, &smooth}) {
      scene->environment = half_space_light(true);
      look_from_afar(*scene, 0.9, 24);
    }
    const Film film = trace(rough, 64);
    EXPECT_EQ(film.counters.nan_samples, 0u);
    const Measured a = image_mean(film), b = image_mean(trace(smooth, 64));
    EXPECT_NEAR(a.mean, b.mean, 4 * std::hypot(a.standard_error, b.standard_error));
  }
}

}  // namespace
}  // namespace translucube::test
