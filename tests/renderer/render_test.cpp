// The mechanics of a render: passes, determinism, films, stopping.

#include "renderer/render.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/film/film_bytes.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

TEST(Passes, CoverEverySampleOnceAndInOrder) {
  for (const std::uint64_t pixels : {1ull, 256ull * 256, 4096ull * 4096})
    for (const std::uint32_t total : {1u, 3u, 4u, 17u, 64u, 1000u, 100'000u}) {
      std::uint32_t next = 0, index = 0;
      while (const auto pass = plan_pass(index, pixels, total)) {
        EXPECT_EQ(pass->index, index++);
        EXPECT_EQ(pass->first_sample, next);
        EXPECT_GT(pass->count, 0u);
        next += pass->count;
      }
      EXPECT_EQ(next, total);
    }
}

TEST(Passes, OfAnOpenEndedRenderAreThoseOfAFixedOne) {
  for (std::uint32_t i = 0; i < 30; ++i) {
    const Pass open = *plan_pass(i, 512 * 512);
    const auto fixed = plan_pass(i, 512 * 512, open.first_sample + open.count);
    ASSERT_TRUE(fixed);
    EXPECT_EQ(open, *fixed);
  }
}

TEST(Render, OfAnotherSeedIsAnotherPicture) {
  Scene scene = half_lit_sphere();
  const Film first = trace(scene, 4);
  scene.seed = 2;
  EXPECT_NE(first.sum, trace(scene, 4).sum);
}

TEST(Render, ContinuesFromAFilmReadBackWithTheSameBits) {
  const Scene scene = half_lit_sphere();
  const Film whole = trace(scene, 24);
  Film film(scene.width, scene.height, 1);
  for (std::uint32_t i = 0; const auto pass = plan_pass(i, 40 * 40, 24); ++i) {
    const PassFilm traced = *trace_pass(scene, *pass, 1);
    merge(film, pass_film_from_bytes(to_bytes(traced)));
    film = film_from_bytes(to_bytes(film));
  }
  EXPECT_EQ(film.sum, whole.sum);
  EXPECT_EQ(film.m2, whole.m2);
  EXPECT_EQ(film.counters.flights, whole.counters.flights);
}

TEST(Render, KeepsToItsTime) {
  const RenderResult result = render(half_lit_sphere(), TimeTarget{0.3}, 2);
  EXPECT_GT(result.film.passes, 0u);
  EXPECT_GT(result.stats.seconds, 0.25);
  EXPECT_LT(result.stats.seconds, 1.5);
}

TEST(Film, RefusesBytesThatAreShortForeignOrChanged) {
  const Scene scene = half_lit_sphere();
  const Film film = trace(scene, 8);
  const std::string bytes = to_bytes(film);
  EXPECT_NO_THROW(film_from_bytes(bytes));
  EXPECT_THROW(film_from_bytes(""), std::runtime_error);
  EXPECT_THROW(film_from_bytes(bytes.substr(0, bytes.size() - 4)), std::runtime_error);
  EXPECT_THROW(pass_film_from_bytes(bytes), std::runtime_error);
  for (const std::size_t at :
       {std::size_t{9}, std::size_t{50}, bytes.size() / 2, bytes.size() - 1}) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    EXPECT_THROW(film_from_bytes(changed), std::runtime_error) << at;
  }
}

TEST(Film, RefusesPassesOutOfOrder) {
  const Scene scene = half_lit_sphere();
  Film film(40, 40, 1);
  EXPECT_THROW(merge(film, *trace_pass(scene, *plan_pass(1, 1600), 1)), std::invalid_argument);
}

TEST(ExplainSample, AddsUpToTheSampleThatItReplays) {
  const Scene scene = half_lit_sphere();
  const std::string log = explain_sample(scene, 20, 20, 5);
  EXPECT_NE(log.find("emit"), std::string::npos);
  EXPECT_NE(log.find("enter"), std::string::npos);
  EXPECT_NE(log.find("radiance"), std::string::npos);
  EXPECT_EQ(log, explain_sample(scene, 20, 20, 5));
}

TEST(NonFiniteLight, IsCountedAndNotHidden) {
  Scene scene = body(Sphere{}, material(1.5, 0, 0));
  scene.environment = UniformEnvironment{{std::nanf(""), 1, 1}};
  look_from_afar(scene, 1, 4);
  const Film film = trace(scene, 4);
  EXPECT_GT(film.counters.nan_samples, 0u);
  EXPECT_TRUE(std::isnan(develop(film).pixels[0]));
}

TEST(CameraInside, AClearSphereTruncatesOnlyTrappedLight) {
  Scene scene = body(Sphere{}, material(1.5, 0, 0));
  scene.width = scene.height = 8;
  scene.camera = Camera({0.9, 0, 0}, {0, 0, 0}, {0, 1, 0}, 60, 8, 8);
  scene.camera_inside = true;
  const Film ahead = trace(scene, 8);
  EXPECT_EQ(ahead.counters.truncated_energy, 0);
  EXPECT_NEAR(image_mean(ahead).mean, 1, 1e-2);
  scene.camera = Camera({0.9, 0, 0}, {0.9, 0, 1}, {0, 1, 0}, 10, 8, 8);
  EXPECT_GT(trace(scene, 1).counters.truncated_energy, 0);
}

}  // namespace
}  // namespace translucube::test
