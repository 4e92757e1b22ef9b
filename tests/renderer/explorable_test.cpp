// Absorption developed from bins of path length against the exact operators, and explorable renders
// against renders with exact lanes of the same paths.

#include "renderer/explorable.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <numeric>

#include "renderer/half.h"
#include "renderer/image_io.h"
#include "renderer/material_cube.h"
#include "tests/support/explorable_error.h"
#include "tests/support/scenes.h"

namespace translucube {
namespace {

using test::SpreadError;

SpectralAbsorber narrow_band() {  // a dye: all colours between clear and black
  return {{380, 500, 540, 560, 600, 780}, {0.01, 0.2, 1, 0.8, 0.02, 0}};
}
SpectralAbsorber red_glass() { return {{400, 560, 620, 700}, {1, 0.8, 0.1, 0.05}}; }
RgbAbsorber plain_rgb() { return {{0.15, 1, 0.5}}; }

double largest_difference(Rgb p, Rgb q) {
  return std::max({std::fabs(p.r - q.r), std::fabs(p.g - q.g), std::fabs(p.b - q.b)});
}

Rgb apply(const Lane& lane, double length) {
  return std::visit([&](const auto& l) { return l.apply(Rgb{1, 1, 1}, length); }, lane);
}

/// White light of one length, developed from the bins.
Rgb apply_spread(const Lane& lane, const BinSpread& spread, double length) {
  const BinWeights s = spread(length);
  Rgb sum;
  for (int i = 0; i < 4; ++i) sum += apply(lane, spread.bins().length(s.bin + i)) * s.weights[i];
  return sum;
}

/// Over lengths in geometric progression.
SpreadError spread_error(const Lane& lane, const BinSpread& spread, double from, double to) {
  SpreadError error;
  constexpr int count = 3000;
  for (int i = 0; i < count; ++i) {
    const double length = from * std::pow(to / from, (i + 0.5) / count);
    const double e = largest_difference(apply_spread(lane, spread, length), apply(lane, length));
    error.largest = std::max(error.largest, e);
    error.mean += e / count;
  }
  return error;
}

TEST(ExplorableBins, WeightsOfEveryLengthAddUpToOne) {
  const BinSpread spread;
  for (double length = 1e-9; length < 1e6; length *= 1.01) {
    const BinWeights s = spread(length);
    EXPECT_NEAR(std::accumulate(s.weights.begin(), s.weights.end(), 0.0), 1, 2e-7) << length;
    EXPECT_GE(s.bin, 1);
    EXPECT_LE(s.bin + 3, spread.bins().count() - 1);
  }
}

TEST(ExplorableBins, WhatIsNeverInsideHasABinOfItsOwn) {
  const BinSpread spread;
  EXPECT_EQ(spread(0).bin, 0);
  EXPECT_EQ(spread(0).weights, (std::array<float, 4>{1, 0, 0, 0}));
  EXPECT_EQ(spread(shortest_length).bin, 1);
  EXPECT_EQ(spread(shortest_length).weights, (std::array<float, 4>{1, 0, 0, 0}));
}

TEST(ExplorableBins, LengthsAtTheNodesGoToThemAlone) {
  const BinSpread spread;
  for (int bin = ExplorableBins::before_nodes; bin < spread.bins().count(); ++bin) {
    const BinWeights s = spread(spread.bins().length(bin));
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(s.weights[i], s.bin + i == bin ? 1 : 0, 1e-4) << bin << ' ' << i;
  }
}

TEST(ExplorableBins, EveryAbsorberStaysWithinAThousandthBetweenTheNodes) {
  const BinSpread spread;
  double mean = 0;
  int count = 0;
  for (double sigma = 1e-4; sigma <= 1e4; sigma *= 1.3)
    for (const Absorber& absorber :
         {Absorber{plain_rgb()}, Absorber{narrow_band()}, Absorber{red_glass()}}) {
      const SpreadError error = spread_error(make_lane(absorber, sigma), spread, 0.003, 300);
      EXPECT_LT(error.largest, 9e-4) << sigma;  // 6e-4 but in the first and the last interval
      mean += error.mean;
      ++count;
    }
  // Most light is far from where the error peaks.
  EXPECT_LT(mean / count, 1e-4);
  std::printf("mean error over lengths and absorbers %.2g\n", mean / count);
}

TEST(ExplorableBins, LengthsBelowTheFirstNodeStayWithinAThousandthUpToTheDensestAbsorption) {
  for (const double densest : {1.0, 50.0, 130.0, 1e3, 3e5}) {
    const BinSpread spread(explorable_bins(densest, 1e9));
    for (const double share : {1e-3, 0.03, 0.3, 1.0})
      for (const Absorber& absorber : {Absorber{plain_rgb()}, Absorber{narrow_band()}})
        EXPECT_LT(
            spread_error(make_lane(absorber, densest * share), spread, 1e-12, spread.bins().first)
                .largest,
            1e-3)
            << densest << ' ' << share;
  }
}

TEST(ExplorableBins, AreThirtyTwoNodesUnlessTheBodyIsLargeOrDense) {
  EXPECT_EQ(explorable_bins(74, 2.7), ExplorableBins{});
  EXPECT_EQ(explorable_bins(74, 0), ExplorableBins{});
  EXPECT_EQ(explorable_bins(0, 0), ExplorableBins{});
  // Without scattering no light turns back early, so nothing is shorter than the body.
  EXPECT_EQ(explorable_bins(1e5, 0), ExplorableBins{});
  const ExplorableBins dense = explorable_bins(1e4, 1e3);
  EXPECT_LE(dense.first, 4e-5);
  EXPECT_GE(dense.last, 3000);
  EXPECT_NEAR(dense.step(), ExplorableBins{}.step(), 1e-12);
  for (const double extreme : {1e-300, 1e300, std::numeric_limits<double>::infinity()})
    for (const double scattering : {0.0, 1e-300, 1e300, std::numeric_limits<double>::infinity()})
      EXPECT_LE(explorable_bins(extreme, scattering).count(), 140);
}

TEST(HalfFloats, ReadBackWhatTheyHold) {
  for (std::uint32_t h = 0; h < 0x7c00; ++h) {
    EXPECT_EQ(float_to_half(half_to_float(static_cast<std::uint16_t>(h))), h);
    EXPECT_EQ(half_to_float(static_cast<std::uint16_t>(h | 0x8000)),
              -half_to_float(static_cast<std::uint16_t>(h)));
  }
  EXPECT_EQ(half_to_float(0x3c00), 1.0f);
  EXPECT_EQ(half_to_float(0x7bff), 65504.0f);
  EXPECT_EQ(half_to_float(0x0001), 0x1p-24f);
}

TEST(HalfFloats, RoundToTheNearest) {
  for (float value = 1e-7f; value < 6e4f; value *= 1.0137f) {
    const float error = std::fabs(half_to_float(float_to_half(-value)) + value);
    EXPECT_LE(error, std::max(value * 0x1p-11f, 0x1p-25f)) << value;
  }
}

// ---- rendered

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

TEST(ExplorableFilm, SurvivesItsCheckpoint) {
  const Film film = explorable_render(sphere(0.3, 0.5), 8);
  const Film read = film_from_bytes(to_bytes(film));
  EXPECT_TRUE(read.shares);
  EXPECT_EQ(read.sum, film.sum);
  EXPECT_EQ(relative_error(read), relative_error(film));
  SceneSpec spec = sphere(0.3, 0.5);
  spec.explorable = Explorable{3.7};
  const auto pass = trace_pass(*build_scene(spec), Pass{0, 0, 4}, 1);
  EXPECT_TRUE(pass_film_from_bytes(to_bytes(*pass)).shares);
  Film plain(film.width, film.height, film.lanes);
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

TEST(ExplorableFilm, HasTheSameBitsForAnyNumberOfThreads) {
  SceneSpec spec = sphere(0.3, 0.5);
  spec.width = 300;
  spec.height = 200;
  spec.explorable = Explorable{3.7};
  const auto scene = build_scene(spec);
  const ExplorableFilm film = explorable_film(*scene, render(*scene, SampleTarget{1}).film);
  const Image one = develop_explorable(film, narrow_band(), 0.05, 1);
  EXPECT_EQ(develop_explorable(film, narrow_band(), 0.05, 2).pixels, one.pixels);
  EXPECT_EQ(develop_explorable(film, narrow_band(), 0.05, 7).pixels, one.pixels);
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

// ---- stored

struct TempFile {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      ("translucube-explorable-" +
       std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "-" +
       std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".exr");
  ~TempFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

ExplorableFilm rendered() {
  SceneSpec spec = sphere(0.3, 0.7);
  spec.width = 37;
  spec.height = 21;
  spec.explorable = Explorable{3.7};
  const auto scene = build_scene(spec);
  return explorable_film(*scene, render(*scene, SampleTarget{4}, 1).film);
}

TEST(StoredExplorableFilm, ReadsBackTheSameBits) {
  const TempFile file;
  const ExplorableFilm film = rendered();
  write_explorable(file.path, film, R"({"seed":7})");
  const StoredExplorable read = read_explorable(file.path);
  EXPECT_EQ(read.request, R"({"seed":7})");
  EXPECT_EQ(read.film.bins, film.bins);
  EXPECT_EQ(read.film.unit_mm, film.unit_mm);
  EXPECT_EQ(read.film.scales, film.scales);
  EXPECT_EQ(read.film.width, 37);
  EXPECT_EQ(read.film.halves, film.halves);
}

TEST(StoredExplorableFilm, HoldsSunsAndDimLightAtOnce) {
  SceneSpec spec = sphere(0, 0);
  spec.explorable = Explorable{3.7};
  const auto scene = build_scene(spec);
  Film film(8, 8, scene->film_lanes(), true);
  film.samples = 1;
  const std::size_t lane = 3 * 64;
  for (int bin = 0; bin < film.lanes; ++bin) film.sum[bin * lane] = 1e6f;  // beyond half's 65504
  for (int bin = 0; bin < film.lanes; ++bin) film.sum[bin * lane + 5] = 1.7f;
  std::fill(film.sum.begin() + 9 * lane, film.sum.begin() + 10 * lane, 3e-12f);  // a dim bin
  const ExplorableFilm halves = explorable_film(*scene, film);
  const auto value = [&](int bin, int channel, int pixel) {
    return halves.scales[bin] * half_to_float(halves.halves[(3 * bin + channel) * 64 + pixel]);
  };
  EXPECT_NEAR(value(4, 0, 0), 1e6, 1e6 / 2048);
  EXPECT_NEAR(value(4, 2, 1), 1.7, 1.7 / 2048);
  EXPECT_NEAR(value(9, 1, 30), 3e-12, 3e-12 / 2048);
}

TEST(StoredExplorableFilm, RefusesOtherFiles) {
  const TempFile file;
  EXPECT_THROW(read_explorable(file.path), ImageError);
  write_image(file.path, Image(4, 4), ImageFormat::exr, {"", "lin_rec709"});
  EXPECT_THROW(read_explorable(file.path), ImageError);
  const ExplorableFilm film = rendered();
  HalfImage image{film.width, film.height, {"R", "G", "B"}, {}};
  write_half_image(file.path, image,
                   {film.halves.begin(), film.halves.begin() + 3 * film.width * film.height});
  EXPECT_THROW(read_explorable(file.path), ImageError);
  write_explorable(file.path, film, "{}");
  std::filesystem::resize_file(file.path, std::filesystem::file_size(file.path) / 2);
  EXPECT_THROW(read_explorable(file.path), ImageError);
}

TEST(StoredExplorableFilm, RefusesHalvesThatAreNotFinite) {
  const TempFile file;
  ExplorableFilm film = rendered();
  film.halves[1000] = 0x7c00;
  write_explorable(file.path, film, "{}");
  EXPECT_THROW(read_explorable(file.path), ImageError);
}

}  // namespace
}  // namespace translucube
