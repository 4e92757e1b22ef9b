// Every sampling routine against its density: chi-squared, both sides, grazing, alpha from 1e-3
// to 1.

#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/light/environment.h"
#include "renderer/optics/lambertian.h"
#include "renderer/optics/medium.h"
#include "renderer/optics/microsurface.h"
#include "tests/support/chi2.h"
#include "tests/support/microsurface.h"

namespace translucube::test {
namespace {

constexpr int samples = 200'000;

Vec3 from_cosine(double mu) { return {std::sqrt(1 - mu * mu), 0, mu}; }

void expect_sampled(const Chi2Result& r, int family, const std::string& what) {
  EXPECT_GT(r.p_value, sidak(family)) << what << ": chi2 " << r.statistic << " of " << r.degrees;
  EXPECT_NEAR(r.total_seen, r.total_pdf, 5e-3) << what;
}

const double alphas[] = {1e-3, 0.03, 0.3, 1}, cosines[] = {1, 0.8, 0.3, 0.02, -0.05, -0.3};

TEST(Sampling, VisibleNormalsFollowTheirDensityFromBothSides) {
  for (const double alpha : alphas)
    for (const double mu : cosines) {
      const Ggx ggx{alpha};
      const Vec3 w = from_cosine(mu);
      Rng rng(7);
      const auto r = chi2_test([&] { return std::optional(ggx.sample_visible(w, rng.uniform2())); },
                               [&](Vec3 m) { return ggx.visible_d(w, m); }, {0, 0, 1},
                               mu > 0 ? alpha / 8 : 0.1, samples);
      expect_sampled(r, 24, "alpha " + std::to_string(alpha) + " cos " + std::to_string(mu));
      EXPECT_NEAR(r.total_pdf, 1, 5e-3) << alpha << " " << mu;
    }
}

TEST(Sampling, MicrofacetBranchesFollowTheirDensityOnBothSides) {
  for (const double eta : {1.5, 1 / 1.5, 2.5, 1.01})
    for (const double alpha : {0.03, 0.3, 1.0})
      for (const double mu : {1.0, 0.8, 0.3, 0.05})
        for (const bool reflected : {true, false}) {
          const Ggx ggx{alpha};
          const Vec3 wo = from_cosine(mu);
          const MicroVertex vertex(ggx, eta, wo, 0.5);
          Rng rng(11);
          const auto draw = [&]() -> std::optional<Vec3> {
            const MicroSample s = vertex.sample(rng.uniform2());
            const MicroBranch& b = reflected ? s.reflected : s.transmitted;
            if (b.weight == 0 || (b.wi.z > 0) != reflected) return {};
            return b.wi;
          };
          const auto pdf = [&](Vec3 wi) {
            return (wi.z > 0) == reflected ? single_scattering(ggx, eta, wo, wi).pdf : 0.0;
          };
          Vec3 axis = reflect(wo, {0, 0, 1});
          if (!reflected) axis = refract(wo, {0, 0, 1}, eta).value_or(Vec3{-wo.x, 0, -0.05});
          const double width = std::max(1e-3, alpha * (reflected ? 0.2 : 0.2 * std::fabs(eta - 1)));
          const auto r = chi2_test(draw, pdf, axis, width, samples);
          expect_sampled(r, 96,
                         "eta " + std::to_string(eta) + " alpha " + std::to_string(alpha) +
                             " cos " + std::to_string(mu) +
                             (reflected ? " reflected" : " transmitted"));
        }
}

TEST(Sampling, HenyeyGreensteinFollowsItsDensityAndItsMeanCosine) {
  for (const double g : {-0.99, -0.5, 0.0, 0.3, 0.9, 0.99}) {
    const Medium medium{1, g};
    const Vec3 before = normalize({1, 2, -1});
    Rng rng(3);
    double mean = 0;
    const auto r = chi2_test(
        [&] {
          const Vec3 after = medium.scatter(before, rng);
          mean += dot(before, after) / samples;
          return std::optional(after);
        },
        [&](Vec3 w) { return henyey_greenstein(g, dot(before, w)); }, g < 0 ? -before : before,
        std::max(1e-3, (1 - std::fabs(g)) / 8), samples);
    expect_sampled(r, 6, "g " + std::to_string(g));
    EXPECT_NEAR(mean, g, 5 / std::sqrt(samples)) << g;
  }
}

TEST(Sampling, FlightsAreExponential) {
  const Medium medium{2.5, 0};
  Rng rng(5);
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    const double t = medium.sample_flight(rng);
    sum += t;
    squares += t * t;
  }
  EXPECT_NEAR(sum / samples, 1 / 2.5, 5 / 2.5 / std::sqrt(samples));
  EXPECT_NEAR(squares / samples, 2 / (2.5 * 2.5),
              5 * std::sqrt(20) / (2.5 * 2.5) / std::sqrt(samples));
}

TEST(Sampling, TheLambertianBackgroundIsCosineDistributed) {
  Rng rng(9);
  const InterfacedLambertian base{SmoothInterface{1.5}};
  const auto r =
      chi2_test([&] { return std::optional(InterfacedLambertian::sample(rng.uniform2())); },
                [&](Vec3 w) { return base.emit(w).pdf; }, {0, 0, 1}, 0.1, samples);
  expect_sampled(r, 1, "lambertian");
}

TEST(Sampling, TheEnvironmentFollowsItsDensity) {
  Image image(32, 16);
  Rng rng(21);
  for (float& p : image.pixels) p = static_cast<float>(rng.uniform() < 0.1 ? 20 : rng.uniform());
  for (const double rotation : {0.0, 1.1}) {
    const ImageEnvironment environment(image, rotation, 1);
    // The density is constant in u, v over a pixel: bins about the pole resolve it well enough.
    const auto r =
        chi2_test([&] { return std::optional(environment.sample(rng.uniform2()).direction); },
                  [&](Vec3 w) { return environment.value_from(w).pdf; }, {0, 1, 0}, 0.3, samples);
    EXPECT_NEAR(r.total_pdf, 1, 5e-3);
    EXPECT_LT(r.statistic / r.degrees, 2.5) << "rotation " << rotation;
  }
}

TEST(Sampling, TheEnvironmentTellsTheSameOfItsSamplesAsOfAnyDirection) {
  Image image(64, 32);
  Rng rng(22);
  for (float& p : image.pixels) p = static_cast<float>(rng.uniform());
  const ImageEnvironment environment(image, 0.4, 2);
  for (int i = 0; i < 1000; ++i) {
    const EnvironmentSample s = environment.sample(rng.uniform2());
    const EnvironmentValue v = environment.value_from(s.direction);
    EXPECT_NEAR(v.radiance.g, s.value.radiance.g, 1e-3 * s.value.radiance.g + 1e-4);
    EXPECT_NEAR(v.pdf / s.value.pdf, 1, 1e-3);
  }
}

TEST(LowDiscrepancy, PairsFillEveryElementaryInterval) {
  // A (0, 2)-sequence: 2^k points leave no box of area 2^-k empty, whatever the scrambling.
  for (const std::uint64_t key : {1ull, 99ull})
    for (int k = 0; k <= 10; ++k)
      for (int split = 0; split <= k; ++split) {
        std::vector<int> count(std::size_t{1} << k, 0);
        for (std::uint32_t i = 0; i < 1u << k; ++i) {
          const Sample2 s = owen_sobol2(i, key, 3);
          const auto x = static_cast<std::size_t>(s.u * (1 << split));
          const auto y = static_cast<std::size_t>(s.v * (1 << (k - split)));
          ++count[x << (k - split) | y];
        }
        EXPECT_TRUE(std::ranges::all_of(count, [](int c) { return c == 1; })) << k << " " << split;
      }
}

}  // namespace
}  // namespace translucube::test
