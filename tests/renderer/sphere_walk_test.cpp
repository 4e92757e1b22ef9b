// The walk in a sphere in SIMD against the scalar one: the same distributions, thin or dense, and
// the same bits on every instruction set that fuses alike.

#include "renderer/transport/sphere/sphere_walk.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/optics/lambertian.h"
#include "renderer/shape/sphere.h"
#include "tests/support/walks.h"

namespace translucube::test {
namespace {

/// What comes out of walks that began with diffuse light at (0, 0, 1).
struct Exits {
  std::vector<double> cosine, height, length;  ///< length [mean free paths]
  double flights = 0;                          ///< of a walk
};

Vec3 entry(Rng& rng) { return -InterfacedLambertian::sample(rng.uniform2()); }

Exits scalar_exits(const Medium& medium, int walks) {
  Exits exits;
  for (int i = 0; i < walks; ++i) {
    Rng rng(hash_combine(1, i));
    Particle particle{{0, 0, 1}, entry(rng), 0};
    Hit hit;
    ++exits.flights;
    while (fly(Sphere{}, medium, particle, rng, hit)) {
      ++exits.flights;
      scatter(Sphere{}, medium, particle, rng);
    }
    exits.cosine.push_back(dot(hit.n, particle.d));
    exits.height.push_back(hit.n.z);
    exits.length.push_back((particle.length + hit.t) * medium.sigma_s);
  }
  exits.flights /= walks;
  return exits;
}

/// `visit(walk)` after each step.
template <class Visit>
void for_each_step(const WalkMedium& medium, int walks, Visit&& visit) {
  auto walk = std::make_unique<SphereWalk>();
  for (int first = 0; first < walks; first += SphereWalk::capacity) {
    for (int i = first; i < std::min(walks, first + int(SphereWalk::capacity)); ++i) {
      Rng rng(hash_combine(2, i));
      const Vec3 d = entry(rng);
      walk->push(i, {0, 0, 1}, 0, d, false, rng.bits());
    }
    while (walk->under_way() > 0) {
      walk->advance(medium);
      visit(*walk);
    }
  }
}

Exits simd_exits(const WalkMedium& medium, int walks) {
  Exits exits;
  for_each_step(medium, walks, [&](const SphereWalk& walk) {
    const SphereWalk::Arrivals& a = walk.arrivals();
    exits.flights += static_cast<double>(walk.under_way() + a.size) / walks;
    for (std::size_t i = 0; i < a.size; ++i) {
      const Vec3 n = a.n[i], d = a.d[i];
      EXPECT_NEAR(length(n), 1, 1e-6);
      EXPECT_NEAR(length(d), 1, 1e-5);
      exits.cosine.push_back(dot(n, d));
      exits.height.push_back(n.z);
      exits.length.push_back(a.length[i] * medium.sigma_s);
    }
  });
  return exits;
}

TEST(SphereWalk, LeavesTheBodyAsTheScalarWalkDoes) {
  constexpr int walks = 30'000;
  for (const double sigma_s : {0.3, 3.0, 30.0, 1e3, 1e6})
    for (const double g : {0.0, 0.6, -0.9}) {
      if (g != 0 && sigma_s > 30) continue;  // the scalar walk takes no large steps there
      const Exits scalar = scalar_exits({sigma_s, g}, walks);
      // Where collisions are visited one by one changes nothing.
      for (const float margin : {0.0f, 4.0f}) {
        const Exits simd = simd_exits({float(sigma_s), float(g), margin, -1}, walks);
        ASSERT_EQ(simd.cosine.size(), std::size_t(walks));
        EXPECT_LT(ks_ratio(scalar.cosine, simd.cosine), 1) << sigma_s << " g " << g;
        EXPECT_LT(ks_ratio(scalar.height, simd.height), 1) << sigma_s << " g " << g;
        EXPECT_LT(ks_ratio(scalar.length, simd.length), 1) << sigma_s << " g " << g;
        if (margin == 0) {
          EXPECT_NEAR(simd.flights, scalar.flights, 0.05 * scalar.flights) << sigma_s << " g " << g;
        }
      }
    }
}

TEST(SphereWalk, MeanLengthIsThatOfTheChords) {
  // Diffuse light at ior 1 (Blanco and Fournier 2003): 4 / 3 of the radius, for any scatterers.
  for (const float g : {0.0f, 0.8f})
    for (const float sigma_s : {0.1f, 2.0f, 10.0f}) {
      double sum = 0, squares = 0;
      constexpr int walks = 200'000;
      for_each_step({sigma_s, g, 0, -1}, walks, [&](const SphereWalk& walk) {
        for (std::size_t i = 0; i < walk.arrivals().size; ++i) {
          const double l = walk.arrivals().length[i];
          sum += l, squares += l * l;
        }
      });
      const double mean = sum / walks;
      const double error = std::sqrt((squares / walks - mean * mean) / walks);
      EXPECT_NEAR(mean, 4.0 / 3, 4 * error) << sigma_s << " g " << g;
      EXPECT_LT(error, 0.02);
    }
}

TEST(SphereWalk, VerticesStandForAllCollisionsNearTheBoundary) {
  // A sum over collisions, each over its chance to be told: the same for all chances.
  constexpr int walks = 100'000;
  const auto sum = [](const WalkMedium& medium) {
    std::vector<double> sums(walks);
    for_each_step(medium, walks, [&](const SphereWalk& walk) {
      const SphereWalk::Vertices& v = walk.vertices();
      for (std::size_t i = 0; i < v.size; ++i) {
        const double optical = 0.5 * medium.sigma_s * v.depth2[i];
        EXPECT_NEAR(v.chance[i], medium.chance(v.depth2[i]), 1e-5);
        EXPECT_NEAR(v.depth2[i], 1 - length_squared(v.p[i]), 3e-6);
        sums[v.slot[i]] += std::exp(-optical) / v.chance[i];
      }
    });
    double mean = 0, squares = 0;
    for (const double s : sums) mean += s / walks, squares += s * s / walks;
    return std::pair{mean, std::sqrt((squares - mean * mean) / walks)};
  };
  for (const float sigma_s : {1.0f, 20.0f}) {
    const auto [all, all_error] = sum({sigma_s, 0, 4, 0});
    const auto [some, some_error] = sum({sigma_s, 0, 4, 0.5f});
    EXPECT_GT(all, 0.1);
    EXPECT_NEAR(all, some, 4 * std::hypot(all_error, some_error)) << sigma_s;
  }
}

TEST(SphereWalk, TellsWhereTheLastFlightBegan) {
  for_each_step({5, 0.3f, 0, 0.5f}, 4'000, [&](const SphereWalk& walk) {
    const SphereWalk::Arrivals& a = walk.arrivals();
    for (std::size_t i = 0; i < a.size; ++i) {
      EXPECT_NEAR(length(a.n[i] - a.from[i] - double(a.flight[i]) * a.d[i]), 0, 1e-5);
      EXPECT_GE(a.phase[i], 0);
    }
  });
}

TEST(SphereWalk, InstructionSetsAgree) {
  std::map<std::string, std::vector<float>> outcomes;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    std::vector<float>& outcome = outcomes[hwy::TargetName(target)];
    for (const float g : {0.0f, 0.7f})
      for_each_step({20, g, 4, 0.5f}, 1'500, [&](const SphereWalk& walk) {
        for (std::size_t i = 0; i < walk.arrivals().size; ++i) {
          outcome.push_back(static_cast<float>(walk.arrivals().slot[i]));
          outcome.push_back(walk.arrivals().length[i]);
          outcome.push_back(walk.arrivals().n.x[i]);
        }
        for (std::size_t i = 0; i < walk.vertices().size; ++i) {
          outcome.push_back(walk.vertices().depth2[i]);
          outcome.push_back(walk.vertices().u[i]);
        }
      });
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
  EXPECT_GE(outcomes.size(), 2u);
  // The same fused operations: the same request gives the same bits on both.
  if (outcomes.contains("AVX2") && outcomes.contains("AVX3")) {
    EXPECT_EQ(outcomes["AVX2"], outcomes["AVX3"]);
  }
}

}  // namespace
}  // namespace translucube::test
