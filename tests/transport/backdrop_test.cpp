// The patterned plane behind a body: furnaces that it must not spoil, and plates on it with known
// answers.

#include "renderer/light/backdrop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/peers.h"
#include "tests/support/truths.h"

namespace translucube::test {
namespace {

/// A map of radiance 1, of which the front half is seen.
ImageEnvironment white_front() {
  Image image(64, 32);
  std::ranges::fill(image.pixels, 1.0f);
  return ImageEnvironment(image, 0.3, 1, EnvironmentSide::front);
}

/// A backdrop of one value behind a body whose least z is `back`.
Backdrop plain(BackdropKind kind, float value, double back, double distance) {
  Backdrop backdrop;
  backdrop.kind = kind;
  backdrop.light = value;
  backdrop.height = back - std::fmax(contact_gap, distance);
  return backdrop;
}

struct Placed {
  AnyShape shape;
  double back;
};
std::vector<Placed> placed_bodies() {
  return {{Sphere{}, -1}, {make_box({0.7, 0.6, 0.1}), -0.1}, {Bowl(0.8), -1}};
}

/// A slab of thickness 1 on a backdrop, seen along its normal; the light comes from the
/// backdrop alone or, on a print, from all around.
Measured plate_on(const Backdrop& backdrop, const Material& m, float sigma_a, float around,
                  std::uint32_t samples) {
  Scene scene = body(wide_plate(), m);
  scene.environment = UniformEnvironment{{around, around, around}};
  scene.lanes = {RgbLane{{sigma_a, sigma_a, sigma_a}}};
  scene.backdrop = backdrop;
  look_from_afar(scene, 0.1, 32);
  return image_mean(trace(scene, samples));
}

TEST(Backdrop, IsSeenThroughGlassLessWhatItsFacesReflect) {
  const double f = 0.04, e = std::exp(-0.5);
  for (const double distance : {0.0, 3.0})
    EXPECT_NEAR(plate_on(plain(BackdropKind::light_table, 2, -0.5, distance), material(1.5, 0, 0),
                         0.5f, 0, 16)
                    .mean,
                2 * (1 - f) * (1 - f) * e / (1 - f * f * e * e), 1e-4);
}

TEST(Backdrop, ThroughAScatteringPlateIsVanDeHulstsTransmittance) {
  // By reciprocity: what diffuse light sends to the normal is what the normal sends to all sides.
  const Measured t = plate_on(plain(BackdropKind::light_table, 1, -0.5, 0),
                              material(1, 0, 90 * 0.02, 0.75), 10 * 0.02f, 0, 512);
  EXPECT_NEAR(t.mean / 0.66096, 1, 5e-3) << t.standard_error;
}

/// Share of diffuse light that crosses a clear plate.
double diffuse_transmittance_of_glass(double ior) {
  double sum = 0;
  constexpr int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double mu = (i + 0.5) / n, f = fresnel(mu, ior);
    sum += 2 * mu * (1 - f) / (1 + f) / n;
  }
  return sum;
}

TEST(Backdrop, UnderGlassAPrintIsDarkerByItsRoundTrips) {
  // Radiance 1 all around: the plate reflects 1 - T, and sends down and up again what Kubelka 1948
  // sums up: T rho T_d / (1 - rho (1 - T_d)).
  const double f = 0.04, t = (1 - f) / (1 + f), t_d = diffuse_transmittance_of_glass(1.5);
  for (const double rho : {0.2, 0.8}) {
    const Measured e =
        plate_on(plain(BackdropKind::print, float(rho), -0.5, 0.5), material(1.5, 0, 0), 0, 1, 192);
    EXPECT_NEAR(e.mean, 1 - t + t * rho * t_d / (1 - rho * (1 - t_d)), 4 * e.standard_error) << rho;
    EXPECT_LT(e.standard_error, 1.6e-3);
  }
}

TEST(Backdrop, ShowsItsPatternInItsPeriod) {
  Backdrop backdrop;
  backdrop.period = 2;
  backdrop.dark = 0.25f;
  const auto bright = [&](double x, double y) { return backdrop.value({x, y, 0}) == 1; };
  EXPECT_TRUE(bright(0.5, -0.5) && bright(-0.5, -0.5) && bright(0.5, 0.5));
  backdrop.pattern = Pattern::checker;
  EXPECT_TRUE(bright(0.5, 0.5) && bright(-0.5, -0.5) && bright(2.5, 4.5));
  EXPECT_FALSE(bright(0.5, -0.5) || bright(-0.5, 0.5) || bright(1.5, 0.5));
  backdrop.pattern = Pattern::stripes;
  EXPECT_TRUE(bright(0.5, 0.5) && bright(0.5, -7.7) && bright(-1.5, 0));
  EXPECT_FALSE(bright(1.5, 0) || bright(-0.5, 0));
  backdrop.pattern = Pattern::grid;
  EXPECT_TRUE(bright(1, 1) && bright(0.11, 0.11) && bright(-0.11, 1));
  EXPECT_FALSE(bright(0.09, 1) || bright(-0.09, 1) || bright(1, 2.05));
  EXPECT_EQ(backdrop.value({0, 0, 0}), 0.25f);
}

/// Light that differs with the direction, the brightest part hidden; what is seen of its blue is 1
/// everywhere.
ImageEnvironment uneven_front() {
  Image image(64, 32);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      float* pixel = &image.pixels[3 * (std::size_t(y) * image.width + x)];
      const bool hidden = x<8, spot = x> 36 && x < 40 && y > 8 && y < 12;
      pixel[0] = hidden ? 50.0f : spot ? 30.0f : 0.1f;
      pixel[1] = hidden ? 50.0f : spot ? 30.0f : 0.2f;
      pixel[2] = hidden ? 50.0f : 1.0f;
    }
  return ImageEnvironment(image, 0.2, 1, EnvironmentSide::front);
}

TEST(Backdrop, UnderUnevenLightTheFurnaceOfOneChannelVanishes) {
  // What looks for light, where any channel is bright, must know what the backdrop hides.
  for (const BackdropKind kind : {BackdropKind::light_table, BackdropKind::print})
    for (const Placed& placed : placed_bodies())
      for (const Material& m : {material(1.5, 0, 3), material(1.5, 0.4, 3), material(1.5, 0.4, 0),
                                material(1.5, 0, infinity)}) {
        Scene scene = body(placed.shape, m, 6);
        scene.environment = uneven_front();
        scene.backdrop = plain(kind, 1, placed.back, 0.2);
        scene.width = scene.height = 16;
        scene.camera = Camera({1.5, 1.2, 3}, {0, 0, 0}, {0, 1, 0}, 45, 16, 16);
        const Measured blue = channel_means(trace(scene, 128))[2];
        SCOPED_TRACE(testing::Message()
                     << placed.shape.index() << " kind " << int(kind) << " alpha "
                     << m.coefficients.alpha << " sigma_s " << m.coefficients.sigma_s);
        EXPECT_NEAR(blue.mean, 1, 4 * blue.standard_error);
        EXPECT_LT(blue.standard_error, 0.03);
      }
}

TEST(Environment, ShowsAndFindsItsFrontAlone) {
  const ImageEnvironment front = uneven_front();
  Rng rng(3);
  for (int i = 0; i < 2000; ++i) {
    const EnvironmentSample light = front.sample({rng.uniform(), rng.uniform()});
    // Cells across the border are drawn, what is behind it is dark.
    EXPECT_GT(light.direction.z, -0.1);
    if (light.direction.z < 0) {
      EXPECT_EQ(light.value.radiance, Rgb{});
    }
    const Vec3 d = sample_isotropic(rng);
    EXPECT_EQ(luminance(front.value_from(d).radiance) > 0, d.z >= 0);
  }
}

TEST(Environment, DrawsItsFrontAsBrightAsItIs) {
  const ImageEnvironment front = white_front();
  Rng rng(4);
  double one = 0, many = 0;
  constexpr int n = 100'000;
  std::vector<Sample2> numbers;
  for (int i = 0; i < n; ++i) numbers.push_back({(i + rng.uniform()) / n, rng.uniform()});
  for (const EnvironmentSample& light : front.sample(numbers))
    many += double(light.value.radiance.r) / light.value.pdf / n;
  for (const Sample2& u : numbers) {
    const EnvironmentSample light = front.sample(u);
    one += double(light.value.radiance.r) / light.value.pdf / n;
  }
  EXPECT_NEAR(one / (2 * std::numbers::pi), 1, 5e-3);
  EXPECT_NEAR(many / (2 * std::numbers::pi), 1, 5e-3);
}

}  // namespace
}  // namespace translucube::test
