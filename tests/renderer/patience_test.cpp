// Time is kept whatever the medium: a first pass ends at its deadline, a stop is obeyed at once.

#include "renderer/base/patience.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "renderer/render.h"
#include "tests/support/meshes.h"
#include "tests/support/sanitized.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct LongWork {
  const char* name;
  Scene scene;
};

/// Bodies whose single pass takes minutes or hours.
std::vector<LongWork> long_works() {
  constexpr double dense = 1e6;
  std::vector<LongWork> works{
      {"forward scattering in a sphere", body(Sphere{}, material(1.5, 0, dense, 0.9))},
      {"under a rough surface", body(Sphere{}, material(1.5, 0.4, dense, 0.9))},
      {"in a box", body(make_box({0.5, 0.5, 0.5}), material(1.5, 0, dense, 0.9))},
      {"in a rough bowl", body(Bowl(0.8), material(1.5, 0.4, dense, -0.9))},
      {"in a mesh", body(build_mesh(icosphere(2)).mesh, material(2.5, 0, dense, 0.9))},
      {"under an image", body(Sphere{}, material(1.5, 0, dense, 0.9))},
      {"between a diamond and a print",
       body(make_box({0.5, 0.5, 0.5}), material(2.5, 0, 1000, 0.9))}};
  works[5].scene.environment = half_space_light(true);
  works[6].scene.backdrop = Backdrop{};
  works[6].scene.backdrop->kind = BackdropKind::print;
  works[6].scene.backdrop->light = 1;
  works[6].scene.backdrop->height = -0.5 - contact_gap;
  for (LongWork& work : works) look_from_afar(work.scene, 0.9, 256);
  return works;
}

constexpr double slack = sanitized ? 2 : 0.2;  // seconds

TEST(Deadline, OfATimeTargetIsKeptByTheFirstPassToo) {
  for (const LongWork& work : long_works()) {
    const auto start = Clock::now();
    const RenderResult result = render(work.scene, TimeTarget{0.5}, 1);
    EXPECT_LT(seconds_since(start), 0.5 + slack) << work.name;
    EXPECT_FALSE(result.stopped);
    EXPECT_EQ(result.film.passes, 1u) << work.name;
    // What was given up is told, and no more than there was.
    EXPECT_GT(result.stats.truncated_energy, 0.01) << work.name;
    EXPECT_LT(result.stats.truncated_energy, 1.001) << work.name;
    EXPECT_EQ(result.stats.nan_samples, 0u) << work.name;
    // A white furnace misses as much light as was given up.
    if (!work.scene.environment.uniform()) continue;
    double mean = 0;
    const Image image = develop(result.film);
    for (const float value : image.pixels) mean += double(value) / double(image.pixels.size());
    EXPECT_NEAR(mean + result.stats.truncated_energy, 1, 0.02) << work.name;
  }
}

TEST(Deadline, SharesTheTimeBetweenAllTiles) {
  const LongWork work = long_works()[1];
  const RenderResult result = render(work.scene, TimeTarget{0.5}, 1);
  const Image image = develop(result.film);
  int dark_rows = 0;
  for (int y = 0; y < image.height; ++y) {
    double sum = 0;
    for (int x = 0; x < image.width; ++x) sum += image.pixels[3 * (y * image.width + x)];
    dark_rows += sum == 0;
  }
  EXPECT_EQ(dark_rows, 0) << "the reflection of the rough surface is everywhere";
}

TEST(Stop, IsObeyedWithin200Milliseconds) {
  for (const LongWork& work : long_works()) {
    std::stop_source stop;
    Clock::time_point asked;
    std::jthread asking([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      asked = Clock::now();
      stop.request_stop();
    });
    const RenderResult result = render(work.scene, SampleTarget{1 << 20}, 2, stop.get_token());
    asking.join();
    EXPECT_TRUE(result.stopped) << work.name;
    EXPECT_LT(seconds_since(asked), slack) << work.name;
  }
}

TEST(Deadline, ThatIsFarAwayChangesNoBit) {
  const Scene scene = half_lit_sphere();
  const Pass pass = *plan_pass(0, 1600);
  const auto never = trace_pass(scene, pass, 1);
  const auto late = trace_pass(scene, pass, 1, {{}, Clock::now() + std::chrono::hours(1)});
  EXPECT_EQ(never->sum, late->sum);
}

}  // namespace
}  // namespace translucube::test
