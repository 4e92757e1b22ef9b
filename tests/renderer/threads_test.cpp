// What several threads do at once: the same bits for any number of them, and no race. Of the tests
// of picture and renderer, these run under ThreadSanitizer too.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <thread>
#include <vector>

#include "picture/color.h"
#include "picture/image_io.h"
#include "renderer/film/explorable_develop.h"
#include "renderer/light/environment_cache.h"
#include "renderer/render.h"
#include "renderer/slab/appearance.h"
#include "tests/support/absorbers.h"
#include "tests/support/meshes.h"
#include "tests/support/repository.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

void expect_same_bits_by_any_number_of_threads(const Scene& scene, std::uint32_t samples) {
  const Film one = trace(scene, samples, 1), two = trace(scene, samples, 2),
             five = trace(scene, samples, 5);
  EXPECT_EQ(one.sum, two.sum);
  EXPECT_EQ(one.m2, two.m2);
  EXPECT_EQ(one.sum, five.sum);
}

TEST(Threads, TraceTheSameBitsHoweverMany) {
  expect_same_bits_by_any_number_of_threads(half_lit_sphere(), 19);
}

// Its distance grid is filled by whoever comes first.
TEST(Threads, TraceADenseMeshWithTheSameBitsHoweverMany) {
  const auto traced = [](int threads) {
    Scene scene = half_lit_sphere();
    scene.shape = build_mesh(knot(96, 24)).mesh;
    scene.interior = make_interior(material(1.5, 0.2, 100), 1.0);
    return trace(scene, 4, threads);
  };
  EXPECT_EQ(traced(1).sum, traced(5).sum);
}

TEST(Threads, TraceTheDipoleWithTheSameBitsHoweverMany) {
  SceneSpec spec;
  spec.material.coefficients = {0.1, 0.16, 0.2};
  spec.material.absorber = plain_rgb();
  spec.model = DipoleModel{0.4};
  spec.environment.source = ImageEnvironmentSpec{in_repository("config/environments/forest.exr")};
  spec.width = spec.height = 32;
  expect_same_bits_by_any_number_of_threads(*build_scene(spec), 12);
}

TEST(Threads, StopWhenAskedTo) {
  const Scene scene = half_lit_sphere();
  std::stop_source stop;
  const RenderResult result =
      render(scene, SampleTarget{1u << 20}, 2, stop.get_token(), [&](const Progress& p) {
        if (p.passes == 3) stop.request_stop();
      });
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.film.passes, 3u);
  EXPECT_EQ(result.film.sum, trace(scene, result.film.samples).sum);
}

TEST(Threads, DevelopTheSameBitsHoweverMany) {
  SceneSpec spec;
  spec.material.coefficients = {0.1, 0.1, 0.1};
  spec.material.absorber = red_glass();
  spec.width = 300;
  spec.height = 200;
  spec.explorable = Explorable{3.7};
  const auto scene = build_scene(spec);
  const ExplorableFilm film = explorable_film(*scene, render(*scene, SampleTarget{1}).film);
  const Image one = develop_explorable(film, narrow_band(), 0.05, 1);
  EXPECT_EQ(develop_explorable(film, narrow_band(), 0.05, 2).pixels, one.pixels);
  EXPECT_EQ(develop_explorable(film, narrow_band(), 0.05, 7).pixels, one.pixels);
}

TEST(Threads, MeasureASlabWithTheSameBitsHoweverMany) {
  // Walks, and added layers.
  for (const double sigma_s : {1.0, 5.0}) {
    Material m;
    m.coefficients = {0.3, 0.2, sigma_s};
    m.ior = 1.5;
    m.absorber = red_glass();
    const SlabAppearance one = slab_appearance(m, 1, 2e-3, 5, 1);
    const SlabAppearance three = slab_appearance(m, 1, 2e-3, 5, 3);
    const SlabAppearance other = slab_appearance(m, 1, 2e-3, 6, 3);
    EXPECT_EQ(one.normal.value.reflected.total, three.normal.value.reflected.total);
    EXPECT_EQ(one.diffuse.value.transmitted.bands, three.diffuse.value.transmitted.bands);
    EXPECT_EQ(one.haze->value, three.haze->value);
    EXPECT_EQ(one.samples, three.samples);
    EXPECT_NE(one.normal.value.reflected.total, other.normal.value.reflected.total);
  }
}

TEST(Threads, ShareTheCachedEnvironments) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("translucube-threads-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, float value) {
    Image image(8, 4);
    std::ranges::fill(image.pixels, value);
    write_image(folder / name, image, ImageFormat::exr, {});
    return folder / name;
  };
  const auto a = write("a.exr", 2), b = write("b.exr", 3);
  EnvironmentCache cache;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&] {
        for (int j = 0; j < 20; ++j) {
          EXPECT_EQ(cache.get(a, 0.1 * (j % 3), 1)->value_from({0, 1, 0}).radiance.g, 2);
          EXPECT_EQ(cache.get(b, 0, 1)->value_from({0, 1, 0}).radiance.g, 3);
        }
      });
  }
  std::filesystem::remove_all(folder);
}

TEST(Threads, ShareAColorConfig) {
  const ColorConfig config(in_repository("config/display.ocio"));
  std::array<double, 4> results{};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        for (int i = 0; i < 25; ++i)
          for (const Display& display : config.displays())
            for (const std::string& view : display.views) {
              Image image(64, 4);
              std::ranges::fill(image.pixels, 0.3f);
              config.apply_display(image, display.name, view);
              for (const float v : image.pixels) results[t] += v;
            }
      });
  }
  for (int t = 1; t < 4; ++t) EXPECT_EQ(results[t], results[0]);
  EXPECT_GT(results[0], 0);
}

}  // namespace
}  // namespace translucube::test
