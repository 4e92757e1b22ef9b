// The files of explorable films.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "picture/half_image.h"
#include "renderer/base/half.h"
#include "renderer/film/explorable_file.h"
#include "renderer/optics/material_cube.h"
#include "renderer/render.h"
#include "renderer/scene/scene.h"
#include "tests/support/absorbers.h"

namespace translucube {
namespace {

SceneSpec small_sphere(double s) {
  SceneSpec spec;
  spec.material.coefficients = from_cube({0.3, 0, s}, 0, 10);
  spec.material.absorber = red_glass();
  spec.width = 37;
  spec.height = 21;
  spec.environment.source = ConstantEnvironmentSpec{Rgb{1, 0.8f, 0.6f}};
  spec.explorable = Explorable{3.7};
  return spec;
}

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
  const auto scene = build_scene(small_sphere(0.7));
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
  const auto scene = build_scene(small_sphere(0));
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
