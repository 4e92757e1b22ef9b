// Explorable renders against renders with exact lanes of the same paths.

#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>

#include "renderer/film/explorable_develop.h"
#include "renderer/film/film_bytes.h"
#include "renderer/film/film_error.h"
#include "renderer/optics/material_cube.h"
#include "tests/support/absorbers.h"
#include "tests/support/explorable_error.h"
#include "tests/support/scenes.h"

namespace translucube {
namespace {

struct CubeAbsorption {
  Absorber absorber;
  double absorption;  ///< the cube's axis
};

constexpr double reference_mm = 10;

/// A sphere under a sky that is bright on one side and coloured on the other, seen with its
/// surroundings.
SceneSpec sphere(double r, double s, double absorption = 0.3) {
  SceneSpec spec;
  spec.material.coefficients = from_cube({absorption, r, s}, 0, reference_mm);
  spec.material.absorber = red_glass();
  spec.width = spec.height = 24;
  spec.environment.source = ConstantEnvironmentSpec{Rgb{1, 0.8f, 0.6f}};
  spec.seed = 7;
  return spec;
}

std::vector<Absorption> five_absorbers() {
  std::vector<Absorption> list;
  for (const CubeAbsorption& a :
       {CubeAbsorption{red_glass(), 0.02}, CubeAbsorption{red_glass(), 0.5},
        CubeAbsorption{narrow_band(), 0.9}, CubeAbsorption{plain_rgb(), 0.3},
        CubeAbsorption{RgbAbsorber{}, 0.9999}})
    list.push_back({a.absorber, from_cube({a.absorption, 0, 0}, 0, reference_mm).sigma_a_peak});
  return list;
}

/// Over the five absorbers.
SpreadError film_error(const SceneSpec& spec, std::uint32_t samples) {
  const std::vector<test::ExplorableError> errors =
      test::explorable_errors(spec, five_absorbers(), 37 / reference_mm, samples, 1);
  SpreadError worst;
  for (const test::ExplorableError& error : errors) {
    worst.largest = std::max(worst.largest, error.film.largest);
    worst.mean += error.film.mean / static_cast<double>(errors.size());
  }
  return worst;
}

TEST(ExplorableFilm, DevelopsLikeExactLanesOfTheSamePaths) {
  for (const double r : {0.0, 0.3, 1.0})
    for (const double s : {0.0, 0.1, 0.5, 0.9, 0.99, 1.0}) {
      const SpreadError error = film_error(sphere(r, s), 4);
      EXPECT_LT(error.largest, 1e-3) << "r " << r << " s " << s;
      EXPECT_LT(error.mean, 2e-4) << "r " << r << " s " << s;
      std::printf("r %.1f s %.2f: largest %.2g mean %.2g\n", r, s, error.largest, error.mean);
    }
}

TEST(ExplorableFilm, DevelopsLikeExactLanesInSmallAndInLargeBodies) {
  for (const double radius_mm : {0.05, 1.0, 1000.0}) {
    SceneSpec spec = sphere(0.2, 0.5);
    spec.object = SphereObject{radius_mm};
    spec.camera.position_mm = {0, 0, 4.5 * radius_mm};
    spec.width = spec.height = 12;
    const SpreadError error = film_error(spec, 4);
    EXPECT_LT(error.largest, 1e-3) << radius_mm;
  }
}

Film explorable_render(SceneSpec spec, std::uint32_t samples = 16) {
  spec.explorable = Explorable{37 / reference_mm};
  return render(*build_scene(spec), SampleTarget{samples}, 1).film;
}

TEST(ExplorableFilm, HasThePictureAndTheErrorOfTheClearBody) {
  const Film film = explorable_render(sphere(0.3, 0.5));
  const Film clear = render(*build_scene(sphere(0.3, 0.5, 0)), SampleTarget{16}, 1).film;
  EXPECT_EQ(film.lanes, 34);
  const Image picture = develop(film), expected = develop(clear);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    ASSERT_NEAR(picture.pixels[i], expected.pixels[i], 2e-5 * expected.pixels[i]);
  EXPECT_NEAR(relative_error(film), relative_error(clear), 1e-3 * relative_error(clear));
  const Image spread = variance(film), expected_spread = variance(clear);
  for (std::size_t i = 0; i < spread.pixels.size(); ++i)
    ASSERT_NEAR(spread.pixels[i], expected_spread.pixels[i],
                1e-3 * expected_spread.pixels[i] + 1e-9);
}

TEST(ExplorableFilm, ThatIsStillBeingTracedDevelopsLikeOneThatIsKept) {
  SceneSpec spec = sphere(0.3, 0.5);
  spec.explorable = Explorable{37 / reference_mm};
  const auto scene = build_scene(spec);
  const Film film = explorable_render(sphere(0.3, 0.5), 8);
  const ExplorableFilm kept = explorable_film(*scene, film);
  const ExplorableBasis basis = explorable_basis(*scene).value();
  const auto expect_alike = [](const Image& a, const Image& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      ASSERT_NEAR(a.pixels[i], b.pixels[i], 1e-3 * b.pixels[i] + 1e-5) << i;
  };
  expect_alike(develop_shares(basis, film), develop_explorable(kept, basis.own));
  for (const Absorption& a : five_absorbers())
    expect_alike(develop_shares(basis, film, a.absorber, a.sigma_a_peak),
                 develop_explorable(kept, a.absorber, a.sigma_a_peak));
}

TEST(ExplorableFilm, SurvivesItsCheckpoint) {
  const Film film = explorable_render(sphere(0.3, 0.5), 8);
  const Film read = film_from_bytes(to_bytes(film));
  EXPECT_TRUE(read.shares);
  EXPECT_EQ(read.sum, film.sum);
  EXPECT_EQ(relative_error(read), relative_error(film));
  SceneSpec spec = sphere(0.3, 0.5);
  spec.explorable = Explorable{3.7};
  const auto pass = trace_pass(*build_scene(spec), Pass{1, 4, 4}, 1);
  EXPECT_TRUE(pass_film_from_bytes(to_bytes(*pass)).shares);
  // All but the meaning of its lanes fits.
  Film plain(film.width, film.height, film.lanes);
  plain.passes = 1;
  plain.samples = 4;
  EXPECT_THROW(merge(plain, *pass), std::invalid_argument);
}

TEST(ExplorableFilm, IsBlackInsideForAnInfiniteAbsorber) {
  for (const double s : {0.0, 0.5, 0.999, 1.0}) {
    SceneSpec spec = sphere(0, s);
    spec.explorable = Explorable{3.7};
    const auto scene = build_scene(spec);
    const ExplorableFilm film = explorable_film(*scene, render(*scene, SampleTarget{4}, 1).film);
    const Image developed =
        develop_explorable(film, red_glass(), std::numeric_limits<double>::infinity());
    const Film black = render(*build_scene(sphere(0, s, 1)), SampleTarget{4}, 1).film;
    const Image expected = develop(black);
    for (std::size_t i = 0; i < expected.pixels.size(); ++i)
      ASSERT_NEAR(developed.pixels[i], expected.pixels[i], 1e-3) << s;
  }
}

TEST(ExplorableFilm, OfABlackMaterialStillServesTheOtherAbsorbers) {
  SceneSpec spec = sphere(0, 0.5, 1);
  spec.explorable = Explorable{3.7};
  const auto scene = build_scene(spec);
  const ExplorableFilm film = explorable_film(*scene, render(*scene, SampleTarget{4}, 1).film);
  const Image developed = develop_explorable(film, red_glass(), 0.0);
  const Image clear = develop(render(*build_scene(sphere(0, 0.5, 0)), SampleTarget{4}, 1).film);
  for (std::size_t i = 0; i < clear.pixels.size(); ++i)
    ASSERT_NEAR(developed.pixels[i], clear.pixels[i], 1e-3 * clear.pixels[i]);
}

TEST(ExplorableFilm, CountsLightThatIsNotFinite) {
  Scene scene = test::body(Sphere{}, test::material(1.5, 0, 0));
  scene.environment = UniformEnvironment{Rgb{std::numeric_limits<float>::infinity(), 1, 1}};
  test::look_from_afar(scene, 2, 4);
  scene.spread.emplace();
  EXPECT_GT(test::trace(scene, 4, 1).counters.nan_samples, 0u);
}

TEST(LanesOfSeveralAbsorptions, AreThoseOfRendersOfTheirOwn) {
  SceneSpec spec = sphere(0.3, 0.5, 0.2);
  spec.more_absorptions = five_absorbers();
  const Film together = render(*build_scene(spec), SampleTarget{8}, 1).film;
  ASSERT_EQ(together.lanes, 6);
  for (std::size_t k = 0; k < spec.more_absorptions.size(); ++k) {
    SceneSpec alone = sphere(0.3, 0.5);
    alone.material.absorber = spec.more_absorptions[k].absorber;
    alone.material.coefficients.sigma_a_peak = spec.more_absorptions[k].sigma_a_peak;
    const Film film = render(*build_scene(alone), SampleTarget{8}, 1).film;
    EXPECT_EQ(develop(together, static_cast<int>(k) + 1).pixels, develop(film).pixels);
  }
}

TEST(LanesOfSeveralAbsorptions, MayHaveAnInfiniteOneAmongThem) {
  SceneSpec spec = sphere(0, 0.5, 1);
  spec.more_absorptions = {{red_glass(), 0.1}};
  const Film film = render(*build_scene(spec), SampleTarget{8}, 1).film;
  const Film black = render(*build_scene(sphere(0, 0.5, 1)), SampleTarget{8}, 1).film;
  const Image lane = develop(film, 0), expected = develop(black);
  for (std::size_t i = 0; i < lane.pixels.size(); ++i)
    ASSERT_NEAR(lane.pixels[i], expected.pixels[i], 1e-6);
  const Image other = develop(film, 1);
  EXPECT_GT(std::accumulate(other.pixels.begin(), other.pixels.end(), 0.0),
            1.1 * std::accumulate(lane.pixels.begin(), lane.pixels.end(), 0.0));
}

}  // namespace
}  // namespace translucube
