// Light found through the smooth boundary of a sphere: every way out is a real one, none is missed,
// and what is found with them is what the walk alone finds.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/optics/fresnel.h"
#include "renderer/transport/sphere/smooth_lights_batch.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

Vec3 random_direction(Rng& rng) { return sample_isotropic(rng); }

/// Where a ray along d from p inside the unit sphere goes on outside; empty if it is trapped.
std::optional<Vec3> leaves_along(double ior, Vec3 p, Vec3 d) {
  Hit hit;
  if (!Sphere{}.intersect_inside(p, d, 1e9, hit)) return {};
  return refract(-d, -hit.n, 1 / ior);
}

constexpr std::array all_branches{ExitBranch::near, ExitBranch::far_falling, ExitBranch::far_rising,
                                  ExitBranch::far_round};

std::vector<SmoothExit> all_exits(double ior, Vec3 p, Vec3 w) {
  std::vector<SmoothExit> found;
  const SmoothExits exits(ior, p);
  for (const ExitBranch branch : all_branches)
    if (const auto exit = exits.towards(w, branch)) found.push_back(*exit);
  return found;
}

TEST(SmoothExits, EveryWayOutLeadsWhereItShould) {
  Rng rng(1);
  for (int i = 0; i < 20'000; ++i) {
    const double ior = 1 + 1.5 * rng.uniform(), rho = std::cbrt(rng.uniform());
    const Vec3 p = rho * random_direction(rng), w = random_direction(rng);
    for (const SmoothExit& exit : all_exits(ior, p, w)) {
      const auto out = leaves_along(ior, p, exit.d);
      ASSERT_TRUE(out) << "ior " << ior << " rho " << rho;
      EXPECT_LT(length(*out - w), 1e-5) << "ior " << ior << " rho " << rho;
      EXPECT_NEAR(length(p + exit.distance * exit.d), 1, 1e-9);
    }
  }
}

TEST(SmoothExits, NoWayOutIsMissed) {
  // A ray in any direction that gets out must be among the ways towards where it goes.
  Rng rng(2);
  int missed = 0, sought = 0;
  for (int i = 0; i < 50'000; ++i) {
    const double ior = 1 + 1.5 * rng.uniform(), rho = std::cbrt(rng.uniform());
    const Vec3 p = rho * random_direction(rng), d = random_direction(rng);
    const auto out = leaves_along(ior, p, d);
    if (!out) continue;
    ++sought;
    bool found = false;
    for (const SmoothExit& exit : all_exits(ior, p, *out)) found |= length(exit.d - d) < 1e-4;
    missed += !found;
  }
  // Next to a caustic two ways melt into one, and rounding decides.
  EXPECT_LT(missed, sought / 2000);
}

TEST(SmoothExits, TheJacobianIsTheRatioOfSolidAngles) {
  Rng rng(3);
  for (int i = 0; i < 2000; ++i) {
    const double ior = 1.1 + rng.uniform(), rho = std::cbrt(rng.uniform());
    const Vec3 p = rho * random_direction(rng), d = random_direction(rng);
    const SmoothExits exits(ior, p);
    const Frame frame(d);
    constexpr double step = 1e-6;
    const auto out = leaves_along(ior, p, d);
    const auto out_x = leaves_along(ior, p, normalize(d + step * frame.x));
    const auto out_y = leaves_along(ior, p, normalize(d + step * frame.y));
    if (!out || !out_x || !out_y) continue;
    const double outside = length(cross(*out_x - *out, *out_y - *out)) / (step * step);
    if (outside < 1e-2 || outside > 1e2) continue;  // caustics and the critical angle
    EXPECT_NEAR(exits.jacobian(d) * outside, 1, 2e-3) << "ior " << ior << " rho " << rho;
  }
}

TEST(SmoothExits, ManyAtATimeAreTheSameAsOne) {
  Rng rng(4);
  for (const ExitBranch branch : all_branches)
    for (const double ior : {1.0, 1.01, 1.33, 1.5, 2.5, 4.0})
      for (const double g : {0.0, 0.7}) {
        const bool near = branch == ExitBranch::near;
        const Medium medium{near ? 5.0 : 0.5, g};
        auto batch = std::make_unique<SmoothExitBatch>();
        std::vector<Vec3> places, before, lights;
        for (std::size_t i = 0; i < SmoothExitBatch::capacity; ++i) {
          // Down to a millionth of the radius below the surface; the far side matters deep inside.
          const double depth =
              near ? std::pow(10, -6 * rng.uniform()) : 0.01 + 0.99 * rng.uniform();
          places.push_back((1 - depth) * random_direction(rng));
          before.push_back(random_direction(rng));
          lights.push_back(random_direction(rng));
          batch->push(places[i], depth * (2 - depth), before[i], lights[i], 0.1);
        }
        find_minima({float(ior)}, *batch);
        find_exits({float(ior), float(medium.sigma_s), float(g)}, branch, Division::balanced,
                   *batch);
        int not_found = 0, differ = 0;
        for (std::size_t i = 0; i < SmoothExitBatch::capacity; ++i) {
          if (batch->share[i] < 0) {
            ++not_found;
            continue;
          }
          double expected = 0, distance = 0;
          if (const auto exit = SmoothExits(ior, places[i]).towards(lights[i], branch)) {
            expected = share_of(medium, ior, *exit, before[i], 0.1, Division::balanced);
            distance = exit->distance;
          }
          const bool same =
              std::fabs(batch->share[i] - expected) < 3e-3 * expected + 1e-4 &&
              (expected < 1e-3 || std::fabs(batch->distance[i] / distance - 1) < 2e-3);
          differ += !same;
        }
        // A caustic, where the share is all or nothing, or the end of a branch.
        EXPECT_LE(differ, 2) << int(branch) << " ior " << ior;
        EXPECT_LE(not_found, 8) << int(branch) << " ior " << ior;
      }
}

/// Lights from everywhere, equally bright.
void fill(LightStrata& lights, Rng& rng) {
  for (std::size_t i = 0; i < LightStrata::size; ++i) lights.set(i, random_direction(rng));
}

/// A batch of the same vertex, on a walk that started elsewhere.
void fill(SmoothExitBatch& batch, double rho, Rng& rng) {
  batch.size = 0;
  const Vec3 p = rho * random_direction(rng), axis = random_direction(rng);
  for (std::size_t i = 0; i < SmoothExitBatch::capacity; ++i) {
    batch.axis.set(i, axis);
    batch.choice[i] = static_cast<float>(rng.uniform());
    batch.drawn[i] = static_cast<float>(rng.uniform());
    batch.turn[i] = static_cast<float>(rng.uniform());
    batch.push(p, 1 - rho * rho, random_direction(rng), {}, 1);
  }
}

struct Mean {
  double sum = 0, squares = 0;
  int n = 0;
  void add(double value) {
    sum += value;
    squares += value * value;
    ++n;
  }
  double mean() const { return sum / n; }
  double standard_error() const { return std::sqrt((squares / n - mean() * mean()) / n); }
};

TEST(SmoothExits, ChosenLightsAndDrawnWaysHaveTheShareAndLengthOfAllThatLeaves) {
  Rng rng(6);
  auto batch = std::make_unique<SmoothExitBatch>();
  auto lights = std::make_unique<LightStrata>();
  for (const double ior : {1.0, 1.33, 1.5, 2.5})
    for (const double rho : {0.05, 0.4, 0.67, 0.9, 0.999}) {
      const double sigma_s = rho > 0.8 ? 0.5 / (1 - rho) : 1;
      const SmoothExitMedium medium{float(ior), float(sigma_s), 0};
      // Isotropic light on the near branch, by the midpoint rule in the cosine.
      double share = 0, length = 0;
      constexpr int steps = 200'000;
      for (int i = 0; i < steps; ++i) {
        const double cosine = (i + 0.5) / steps, sin2_i = rho * rho * (1 - cosine * cosine);
        if (ior * ior * sin2_i >= 1) continue;
        const double cos_i = std::sqrt(1 - sin2_i);
        const double distance = (1 - rho) * (1 + rho) / (cos_i + rho * cosine);
        const double out =
            0.5 / steps * (1 - fresnel(cos_i, 1 / ior)) * std::exp(-sigma_s * distance);
        share += out;
        length += out * distance;
      }
      Mean chosen, chosen_length, drawn, drawn_length;
      for (int repeat = 0; repeat < 400; ++repeat) {
        fill(*lights, rng);
        fill(*batch, rho, rng);
        choose_lights(medium, *lights, rng.bits() % LightStrata::positions, *batch);
        find_exits(medium, ExitBranch::near, Division::connected, *batch);
        draw_exits(medium, *batch);
        // The vertices of a batch share their lights: its means are what is independent.
        Mean of_chosen, of_chosen_length;
        for (std::size_t i = 0; i < batch->size; ++i) {
          const double found = std::fmax(0, batch->share[i]) * 4 * std::numbers::pi;
          of_chosen.add(found);
          of_chosen_length.add(found > 0 ? found * batch->distance[i] : 0);
          drawn.add(batch->drawn_share[i]);
          drawn_length.add(double(batch->drawn_share[i]) * batch->drawn_distance[i]);
        }
        chosen.add(of_chosen.mean());
        chosen_length.add(of_chosen_length.mean());
      }
      const auto expect = [&](const Mean& mean, double truth) {
        EXPECT_NEAR(mean.mean(), truth, 4 * mean.standard_error() + 1e-4 * truth)
            << "ior " << ior << " rho " << rho;
        EXPECT_LT(mean.standard_error(), 0.01 * truth) << "ior " << ior << " rho " << rho;
      };
      expect(chosen, share);
      expect(chosen_length, length);
      expect(drawn, share);
      expect(drawn_length, length);
    }
}

TEST(SmoothExits, AChosenLightIsOneOfTheListTurnedAboutTheAxis) {
  Rng rng(7);
  auto batch = std::make_unique<SmoothExitBatch>();
  auto lights = std::make_unique<LightStrata>();
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < LightStrata::size; ++i) {
    directions.push_back(random_direction(rng));
    lights->set(i, directions[i]);
  }
  fill(*batch, 0.9, rng);
  choose_lights({1.5f, 1, 0}, *lights, 60, *batch);
  for (std::size_t i = 0; i < batch->size; ++i) {
    const Vec3 axis = batch->axis[i], light = batch->light[i];
    const Vec3 original = directions[batch->chosen[i]];
    EXPECT_NEAR(length(light), 1, 1e-5);
    EXPECT_NEAR(dot(light, axis), dot(original, axis), 1e-5);
    const double stratum = double(batch->chosen[i] / LightStrata::positions);
    const double turn = 2 * std::numbers::pi * (batch->turn[i] + stratum / LightStrata::candidates);
    const Vec3 across = original - dot(original, axis) * axis;
    EXPECT_NEAR(dot(light, across), std::cos(turn) * length_squared(across), 1e-5);
  }
}

TEST(SmoothExits, InstructionSetsDifferByRoundingAlone) {
  Rng rng(5);
  auto batch = std::make_unique<SmoothExitBatch>();
  for (std::size_t i = 0; i < SmoothExitBatch::capacity; ++i) {
    const double depth = 0.001 + 0.9 * rng.uniform();
    batch->push((1 - depth) * random_direction(rng), depth * (2 - depth), random_direction(rng),
                random_direction(rng), 0.1);
  }
  for (const ExitBranch branch : all_branches) {
    std::map<std::string, SmoothExitBatch::Floats> shares;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().DeInit();
      find_minima({1.5f}, *batch);
      find_exits({1.5f, 2, 0.3f}, branch, Division::balanced, *batch);
      shares[hwy::TargetName(target)] = batch->share;
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().DeInit();
    }
    const SmoothExitBatch::Floats& first = shares.begin()->second;
    for (const auto& [name, share] : shares) {
      int differ = 0;
      for (std::size_t i = 0; i < first.size(); ++i)
        differ += first[i] >= 0 && share[i] >= 0 &&
                  std::fabs(share[i] - first[i]) > 3e-3 * first[i] + 1e-4;
      EXPECT_LE(differ, 2) << name;
    }
    // The same fused operations: the same request gives the same bits on both.
    if (shares.contains("AVX2") && shares.contains("AVX3")) {
      EXPECT_EQ(shares["AVX2"], shares["AVX3"]);
    }
    EXPECT_GE(shares.size(), 2u);
  }
}

TEST(SmoothExits, InstructionSetsChooseAndDrawTheSame) {
  Rng rng(8);
  auto lights = std::make_unique<LightStrata>();
  fill(*lights, rng);
  auto vertices = std::make_unique<SmoothExitBatch>();
  fill(*vertices, 0.9, rng);
  std::map<std::string, std::unique_ptr<SmoothExitBatch>> results;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    auto batch = std::make_unique<SmoothExitBatch>(*vertices);
    choose_lights({1.5f, 2, 0}, *lights, 120, *batch);
    draw_exits({1.5f, 2, 0}, *batch);
    results[hwy::TargetName(target)] = std::move(batch);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
  const SmoothExitBatch& first = *results.begin()->second;
  for (const auto& [name, batch] : results) {
    int differ = 0;
    for (std::size_t i = 0; i < first.size; ++i) {
      differ += batch->chosen[i] != first.chosen[i];
      EXPECT_NEAR(batch->drawn_share[i], first.drawn_share[i], 1e-5) << name;
      EXPECT_NEAR(batch->drawn_distance[i], first.drawn_distance[i], 1e-5) << name;
    }
    EXPECT_LE(differ, 2) << name;
  }
  if (results.contains("AVX2") && results.contains("AVX3")) {
    const SmoothExitBatch &a = *results["AVX2"], &b = *results["AVX3"];
    EXPECT_EQ(a.chosen, b.chosen);
    EXPECT_TRUE(a.light == b.light);
    EXPECT_EQ(a.light_pdf, b.light_pdf);
    EXPECT_EQ(a.drawn_share, b.drawn_share);
    EXPECT_EQ(a.drawn_distance, b.drawn_distance);
    EXPECT_EQ(a.drawn_cosine, b.drawn_cosine);
  }
}

/// Light from one side, so that near and far ways out differ, seen through a half-open lane.
Scene half_lit(double sigma_s, double ior, float sigma_a) {
  Scene scene = body(Sphere{}, material(ior, 0, sigma_s));
  scene.environment = half_space_light(false);
  scene.lanes = {RgbLane{{sigma_a, sigma_a, sigma_a}}};
  look_from_afar(scene, 0.95, 32);
  return scene;
}

TEST(SmoothConnections, FindWhatTheWalkAloneFinds) {
  for (const double sigma_s : {0.3, 3.0, 20.0}) {
    const Film connected = trace(half_lit(sigma_s, 1.5, 0.3f), 512);
    Scene plain = half_lit(sigma_s, 1.5, 0.3f);
    light_by_a_table(plain);
    const Film walked = trace(plain, 1024);
    EXPECT_GT(connected.counters.light_samples, 0u);
    EXPECT_EQ(walked.counters.light_samples, 0u);
    const Measured a = image_mean(connected), b = image_mean(walked);
    EXPECT_NEAR(a.mean, b.mean, 4 * std::hypot(a.standard_error, b.standard_error)) << sigma_s;
    EXPECT_LT(std::hypot(a.standard_error, b.standard_error), 0.015 * b.mean) << sigma_s;
  }
}

}  // namespace
}  // namespace translucube::test
