// Lamps beside the environment: what they send, how they are drawn, and that every estimator finds
// as much of them as paths alone do.

#include "renderer/light/lighting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "renderer/light/harmonics.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

using std::numbers::pi;
constexpr double one_degree = pi / 180;
const UniformEnvironment dark{{0, 0, 0}};

AreaLight disc_above(double height, double radius) {
  return {AreaLight::Outline::disc,
          {0, 0, height},
          {0, 0, -1},
          {1, 0, 0},
          {0, 1, 0},
          radius,
          radius,
          {1, 1, 1}};
}
AreaLight rectangle_above(double height, double half_width, double half_height) {
  AreaLight lamp = disc_above(height, 1);
  lamp.outline = AreaLight::Outline::rectangle;
  lamp.half_width = half_width;
  lamp.half_height = half_height;
  return lamp;
}

/// The irradiance at the origin on a surface with this normal, by drawing directions.
Measured irradiance(const Lighting& lighting, Vec3 n) {
  constexpr int count = 1 << 16;
  Rng rng(1);
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const EnvironmentSample light = lighting.sample({(i + rng.uniform()) / count, rng.uniform()});
    const EnvironmentValue value = lighting.value_from(light.direction);
    EXPECT_NEAR(value.pdf, light.value.pdf, 1e-6 * value.pdf);
    EXPECT_NEAR(value.radiance.g, light.value.radiance.g, 1e-3f);  // a map's place in floats
    const Rgb radiance = value.radiance + lighting.from_near({}, light.direction);
    const double x = radiance.g * std::fmax(0, dot(n, light.direction)) / value.pdf;
    sum += x;
    squares += x * x;
  }
  const double mean = sum / count;
  return {mean, std::sqrt((squares / count - mean * mean) / count)};
}

TEST(Sun, HasTheIrradianceThatItIsGiven) {
  for (const double diameter : {0.05, 0.53, 10.0, 90.0, 180.0}) {
    const Lighting lighting(dark, {Sun({0, 3, 4}, diameter * one_degree, {1, 2, 3})});
    const Measured facing = irradiance(lighting, {0, 0.6, 0.8});
    EXPECT_NEAR(facing.mean, 2, 4 * facing.standard_error + 1e-5) << diameter;
    if (diameter > 50) continue;
    const Measured askew = irradiance(lighting, {0, 0, 1});
    EXPECT_NEAR(askew.mean, 1.6, 4 * askew.standard_error + 1e-5) << diameter;
  }
}

TEST(AreaLight, HasTheIrradianceOfItsClosedForm) {
  for (const double height : {1.5, 4.0, 40.0}) {
    const Measured disc = irradiance(Lighting(dark, {}, {disc_above(height, 1)}), {0, 0, 1});
    const double sine2 = 1 / (1 + height * height);
    EXPECT_NEAR(disc.mean, pi * sine2, 4 * disc.standard_error);
    EXPECT_LT(disc.standard_error, 0.05 * disc.mean);
    // A quarter of a rectangle over one of its corners (Hamilton and Morgan 1952).
    const double a = 0.5 / height, b = 1.5 / height;
    const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
    const double corner = (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * pi);
    const Measured rectangle =
        irradiance(Lighting(dark, {}, {rectangle_above(height, 0.5, 1.5)}), {0, 0, 1});
    EXPECT_NEAR(rectangle.mean, 4 * pi * corner, 4 * rectangle.standard_error);
  }
  EXPECT_EQ(disc_above(3, 1).seen({0, 0, 4}, {0, 0, -1}), Rgb{});  // from behind
  EXPECT_EQ(disc_above(3, 1).seen({0, 0, 0}, {0, 0, -1}), Rgb{});
}

TEST(AreaLight, KnowsWhetherItIsOutsideOfTheBody) {
  EXPECT_FALSE(disc_above(1.01, 9).reaches_unit_sphere());
  EXPECT_TRUE(disc_above(0.99, 0.01).reaches_unit_sphere());
  AreaLight beside = disc_above(0.5, 1);
  beside.center.x = 1.9;
  EXPECT_FALSE(beside.reaches_unit_sphere());
  beside.center.x = 1.8;
  EXPECT_TRUE(beside.reaches_unit_sphere());
}

TEST(Lighting, AddsUpWhatItHas) {
  const Lighting all(ImageEnvironment(half_space_light(true)),
                     {Sun({0, 0, 1}, 5 * one_degree, {1, 1, 1}), Sun({0, 1, 1}, 1 * one_degree, {3, 3, 3})},
                     {disc_above(10, 2)});
  const Measured e = irradiance(all, {0, 0, 1});
  const double truth = pi + 1 + 3 * std::sqrt(0.5) + pi * 4 / 104;
  EXPECT_NEAR(e.mean, truth,
              4 * e.standard_error + 2e-3 * truth);  // the map's edge is a pixel wide
  EXPECT_EQ(all.uniform(), nullptr);
  EXPECT_NE(Lighting(UniformEnvironment{}).uniform(), nullptr);
}

TEST(Lighting, IsHiddenBelowAPlane) {
  for (const EnvironmentSide side : {EnvironmentSide::front, EnvironmentSide::above}) {
    const Vec3 up = side == EnvironmentSide::front ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    const Lighting hidden(UniformEnvironment{}, {Sun(-up, one_degree, {1, 1, 1})}, {}, side);
    EXPECT_NEAR(irradiance(hidden, up).mean, pi, 0.1);
    EXPECT_EQ(irradiance(hidden, -up).mean, 0);
  }
}

TEST(Harmonics, AreOrthonormal) {
  std::vector<Rgb> one(16), other(16);
  for (std::size_t i = 0; i < 16; ++i)
    for (std::size_t j = i; j < 16; ++j) {
      one.assign(16, {});
      other.assign(16, {});
      one[i].g = other[j].g = 1;
      double sum = 0;
      constexpr int rows = 96, columns = 32;
      for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
          const double z = (y + 0.5) / rows * 2 - 1, phi = 2 * pi * x / columns;
          const double r = std::sqrt(1 - z * z);
          const Vec3 d{r * std::cos(phi), z, r * std::sin(phi)};
          sum += double(radiance_of_harmonics(one, d).g) * radiance_of_harmonics(other, d).g;
        }
      EXPECT_NEAR(sum * 4 * pi / (rows * columns), i == j, 2e-3) << i << " " << j;
    }
}

TEST(Harmonics, OfOrderOneLieAlongXAndYAndZ) {
  const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<Rgb> only(4);
    only[1 + i].r = 1;
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(radiance_of_harmonics(only, axes[j]).r, i == j ? std::sqrt(3 / (4 * pi)) : 0,
                  1e-6);
  }
}

struct Lit {
  const char* name;
  Scene scene;
};
std::vector<Lit> lit_bodies() {
  const BuiltMesh ball = build_mesh(icosphere(3));
  std::vector<Lit> all{{"smooth sphere", body(Sphere{}, material(1.5, 0, 4))},
                       {"dense sphere", body(Sphere{}, material(1.5, 0, 40, 0.5))},
                       {"rough sphere", body(Sphere{}, material(1.5, 0.3, 4))},
                       {"box", body(make_box({0.5, 0.6, 0.6}), material(1.5, 0, 4))},
                       {"ball", body(ball.mesh, material(1.5, 0, 4))},
                       {"rough ball", body(ball.mesh, material(1.5, 0.3, 4))},
                       {"rough glass", body(Sphere{}, material(1.5, 0.3, 0))},
                       {"diffuse", body(Sphere{}, material(1.5, 0, infinity))},
                       {"diffuse bowl", body(Bowl(0.8), material(1.5, 0.1, infinity))}};
  for (Lit& lit : all) look_from_afar(lit.scene, 0.95, 24);
  return all;
}

void expect_same(const char* name, const Film& a, const Film& b, double accuracy) {
  const Measured p = image_mean(a), q = image_mean(b);
  const double error = std::hypot(p.standard_error, q.standard_error);
  EXPECT_NEAR(p.mean, q.mean, 4 * error) << name;
  EXPECT_LT(error, accuracy * q.mean) << name;
}

TEST(AreaLight, AsAWidePlaneIsTheLightTableThatNothingLooksFor) {
  for (auto& [name, scene] : lit_bodies()) {
    AreaLight plane = rectangle_above(-2, 1e5, 1e5);
    plane.normal = {0, 0, 1};
    scene.environment = Lighting(dark, {}, {plane});
    const Film found = trace(scene, 64);
    light_by_a_table(scene);
    scene.seed = 2;
    expect_same(name, found, trace(scene, 128), 0.03);
  }
}

TEST(AreaLight, FarAwayIsASun) {
  for (auto& [name, scene] : lit_bodies()) {
    // 10 degrees wide.
    const double distance = 1e4, radius = distance * std::tan(5 * one_degree);
    const Vec3 towards = normalize({1, 2, 2});
    AreaLight lamp = disc_above(0, radius);
    lamp.center = distance * towards;
    lamp.normal = -towards;
    const Frame frame(lamp.normal);
    lamp.x = frame.x, lamp.y = frame.y;
    scene.environment = Lighting(dark, {}, {lamp});
    const Film near = trace(scene, 64);
    const double sine = std::sin(5 * one_degree);
    const auto irradiance = static_cast<float>(pi * sine * sine);
    scene.environment =
        Lighting(dark, {Sun(towards, 10 * one_degree, {irradiance, irradiance, irradiance})});
    scene.seed = 2;
    expect_same(name, near, trace(scene, 64), 0.06);
  }
}

TEST(AreaLight, NearByLightsADiffuseFaceByItsClosedForm) {
  // A white Lambertian box without interface; the camera sees the middle of its front.
  Scene scene = body(make_box({0.5, 0.5, 0.5}), material(1, 0, infinity));
  look_from_afar(scene, 0.01, 8);
  scene.environment = Lighting(dark, {}, {disc_above(3.5, 1)});
  // The disc itself stands in the way of a camera behind it, but hides nothing.
  const Measured e = image_mean(trace(scene, 4096));
  EXPECT_NEAR(e.mean, 1 / (1 + 9.0), 4 * e.standard_error + 1e-4);
  EXPECT_LT(e.standard_error, 1e-3);
}

}  // namespace
}  // namespace translucube::test
