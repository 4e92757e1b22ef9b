// The walk with large steps against the plain analog walk, and its positions in bodies of any
// density.

#include "renderer/transport/walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/optics/lambertian.h"
#include "renderer/shape/sphere.h"
#include "tests/support/walks.h"

namespace translucube::test {
namespace {

struct Exit {
  double mu, length;
};

/// The reference: one flight after the other from the centre of a unit sphere.
Exit analog_exit(double sigma_s, Rng& rng) {
  Particle particle{{0, 0, 0}, sample_isotropic(rng), 0};
  Hit hit;
  while (fly(Sphere{}, Medium{sigma_s, 0}, particle, rng, hit)) particle.d = sample_isotropic(rng);
  return {dot(hit.n, particle.d), (particle.length + hit.t) * sigma_s};
}

TEST(LargeSteps, LeaveABallAsTheAnalogWalkDoes) {
  constexpr int n = 50'000;
  for (const int level : {0, 1, 2, 4}) {
    Rng rng(17 + level);
    std::vector<double> mu[2], length[2];
    for (int i = 0; i < n; ++i) {
      const Exit exit = analog_exit(ball_radius(level), rng);
      const BallCrossing crossing = cross_ball(level, rng);
      mu[0].push_back(exit.mu);
      length[0].push_back(exit.length);
      mu[1].push_back(dot(crossing.direction, crossing.outward));
      length[1].push_back(crossing.length);
    }
    EXPECT_LT(ks_ratio(mu[0], mu[1]), 1) << level;
    EXPECT_LT(ks_ratio(length[0], length[1]), 1) << level;
  }
}

TEST(LargeSteps, AreIsotropicAboutTheCentre) {
  Rng rng(5);
  Vec3 mean;
  constexpr int n = 100'000;
  for (int i = 0; i < n; ++i) mean = mean + (1.0 / n) * cross_ball(3, rng).outward;
  EXPECT_LT(length(mean), 5 / std::sqrt(n));
}

TEST(Sphere, RollsAsItReflectsChordByChord) {
  const Sphere sphere;
  Rng rng(8);
  for (int i = 0; i < 200; ++i) {
    Vec3 p = sample_isotropic(rng), d = -InterfacedLambertian::sample(rng.uniform2());
    d = Frame(p).to_world(d);
    const double distance = 7 * rng.uniform();
    Vec3 q = p, e = d;
    Hit hit;
    double left = distance;
    while (sphere.intersect_inside(q, e, left, hit)) {
      left -= hit.t;
      q = hit.p;
      e = reflect(-e, hit.n);
    }
    q = q + left * e;
    Sphere::roll(p, d, distance);
    EXPECT_LT(length(p - q), 1e-7) << distance;
    EXPECT_LT(length(d - e), 1e-7) << distance;
  }
}

TEST(LargeSteps, FitIntoTheBody) {
  for (const double radius : {1.9, 2.0, 3.99, 4.0, 1e3, 1e12}) {
    const int level = ball_level(radius);
    if (radius < 2) {
      EXPECT_EQ(level, -1);
    } else {
      EXPECT_LE(ball_radius(level), radius);
      EXPECT_GT(2 * ball_radius(level), std::min(radius, 1e12));
    }
  }
  EXPECT_EQ(ball_level(std::nan("")), -1);
}

MeanLength mean_length(const Medium& medium, int walks, std::uint64_t key) {
  return mean_length(Sphere{}, 4.0 / 3, enter_sphere, medium, 1, walks, key);
}

TEST(MeanPathLength, StaysExactUpToAMillionMeanFreePaths) {
  for (const double sigma_s : {1.0, 1e2, 1e4, 1e6}) {
    const MeanLength m = mean_length({sigma_s, 0}, 300'000, 3);
    EXPECT_NEAR(m.mean, 1, 3.5 * m.standard_error) << sigma_s;
    EXPECT_LT(m.standard_error, 1e-2) << sigma_s << ", collisions " << m.collisions;
  }
}

TEST(LongMeanPathLength, StaysExactToHalfAPercentUpToAMillionMeanFreePaths) {
  for (const double sigma_s : {1e4, 1e6}) {
    const MeanLength m = mean_length({sigma_s, 0}, 8'000'000, 9);
    EXPECT_NEAR(m.mean, 1, 5e-3) << sigma_s;
    EXPECT_LT(m.standard_error, 1.8e-3) << sigma_s;
  }
}

TEST(MeanPathLength, OfTheAnalogWalkInAForwardScatteringMediumIsTheSame) {
  const MeanLength m = mean_length({200, 0.9}, 60'000, 4);
  EXPECT_NEAR(m.mean, 1, 4 * m.standard_error);
  EXPECT_LT(m.standard_error, 1e-2);
}

TEST(Walk, CostsALogarithmOfTheDensity) {
  const double thin = mean_length({30, 0}, 20'000, 5).collisions;
  const double dense = mean_length({1e6, 0}, 20'000, 6).collisions;
  EXPECT_LT(dense, 8 * thin);  // an analog walk: 30,000 times as many
}

}  // namespace
}  // namespace translucube::test
