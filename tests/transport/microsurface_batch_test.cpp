// Rough interfaces in SIMD: the values are those of the closed form, the two ways to light
// add up, and the instruction sets agree.

#include "renderer/optics/microsurface_batch.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/transport/walk.h"
#include "tests/support/microsurface.h"

namespace translucube::test {
namespace {

/// Light that differs between directions, so that it is looked for; its mean radiance is 1.
Environment mottled_light() {
  Image image(64, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c)
        image.pixels[3 * (64 * y + x) + c] = (x / 4 + y / 4) % 2 ? 1.8f : 0.2f;
  return ImageEnvironment(image, 0.3, 1);
}

/// The light that reaches rays along -wo by reflection at, or through, an interface with normal +z:
/// by escapes alone, or weighted against light that was looked for.
Measured light_of(double alpha, double eta, bool from_outside, Vec3 wo, std::uint32_t lights_each) {
  const Environment environment = mottled_light();
  const auto& image = std::get<ImageEnvironment>(environment);
  const BatchInterface interface { float(alpha), float(eta), from_outside };
  auto batch = std::make_unique<MicrosurfaceBatch>();
  std::vector<double> means;
  for (int repeat = 0; repeat < 400; ++repeat) {
    const LightList lights(Lighting(environment), hash_combine(3, repeat));
    Rng rng(hash_combine(4, repeat));
    for (std::size_t i = 0; i < MicrosurfaceBatch::capacity; ++i)
      batch->push({0, 0, 1}, -wo, rng.uniform2(), rng.bits());
    batch->start(interface);
    double sum = 0;
    while (batch->under_way() > 0) {
      batch->collide(interface, lights, lights_each);
      const MicrosurfaceBatch::Lit& lit = batch->lit();
      for (std::size_t i = 0; i < lit.size; ++i)
        sum += lit.share[i] * lights.radiance[lit.light[i]].g;
      const MicrosurfaceBatch::Sent& sent = batch->sent();
      for (std::size_t i = 0; i < sent.size; ++i) {
        const EnvironmentValue light = image.value_from(sent.direction[i]);
        const double sought = lights_each * light.pdf;
        sum += sent.weight[i] * light.radiance.g * sent.pdf[i] / (sent.pdf[i] + sought);
      }
    }
    means.push_back(sum / MicrosurfaceBatch::capacity);
  }
  double mean = 0, squares = 0;
  for (const double m : means) mean += m / means.size(), squares += m * m / means.size();
  return {mean, std::sqrt((squares - mean * mean) / (means.size() - 1))};
}

TEST(MicrosurfaceBatch, LightLookedForAndLightFoundAddUp) {
  for (const double alpha : {0.05, 0.3, 1.0})
    for (const double eta : {1.5, 1 / 1.5})
      for (const bool from_outside : {true, false})
        for (const double mu : {0.95, 0.4}) {
          const Vec3 wo{std::sqrt(1 - mu * mu), 0, mu};
          const Measured found = light_of(alpha, eta, from_outside, wo, 0);
          for (const std::uint32_t lights_each : {1u, 8u}) {
            const Measured both = light_of(alpha, eta, from_outside, wo, lights_each);
            EXPECT_NEAR(both.mean, found.mean,
                        4.5 * std::hypot(both.standard_error, found.standard_error))
                << "alpha " << alpha << " eta " << eta << " mu " << mu << " lights " << lights_each;
          }
        }
}

TEST(MicrosurfaceBatch, SharesAreThoseOfASingleScatteringInClosedForm) {
  // At the first collision, averaged over its depth on both sides and over which lights it asks.
  const LightList lights(Lighting(mottled_light()), 5);
  constexpr std::uint32_t lights_each = 8;
  for (const double alpha : {0.1, 0.5})
    for (const double eta : {1.5, 1 / 1.5})
      for (const bool from_outside : {true, false}) {
        const Vec3 wo{0.6, 0, 0.8};
        const BatchInterface interface { float(alpha), float(eta), from_outside, false };
        auto batch = std::make_unique<MicrosurfaceBatch>();
        double sum = 0, squares = 0;
        int rays = 0;
        Rng rng(6);
        for (int repeat = 0; repeat < 100; ++repeat) {
          std::array<double, MicrosurfaceBatch::capacity> shares{};
          for (std::size_t i = 0; i < shares.size(); ++i, ++rays)
            batch->push({0, 0, 1}, -wo, rng.uniform2(), rng.bits());
          batch->start(interface);
          batch->collide(interface, lights, lights_each);
          for (std::size_t i = 0; i < batch->lit().size; ++i)
            shares[batch->lit().slot[i]] += batch->lit().share[i];
          for (const double share : shares) sum += share, squares += share * share;
        }
        double expected = 0;
        for (std::uint32_t l = 0; l < LightList::size; ++l) {
          const Vec3 wi = lights.direction[l];
          if ((wi.z > 0) != from_outside) continue;
          const LobeValue value = single_scattering(Ggx{alpha}, eta, wo, wi);
          if (value.f_cos > 0)
            expected += value.f_cos / (lights_each * lights.pdf[l] + value.pdf) * lights_each /
                        LightList::size;
        }
        const double mean = sum / rays, error = std::sqrt((squares / rays - mean * mean) / rays);
        EXPECT_NEAR(mean, expected, 4.5 * error) << "alpha " << alpha << " eta " << eta;
        EXPECT_LT(error, 0.02 * expected) << "alpha " << alpha << " eta " << eta;
      }
}

TEST(MicrosurfaceBatch, InstructionSetsAgree) {
  const LightList lights(Lighting(mottled_light()), 7);
  struct Outcome {
    std::vector<float> shares, weights, inward;
    bool operator==(const Outcome&) const = default;
  };
  std::map<std::string, Outcome> outcomes;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    const BatchInterface interface { 0.4f, 1 / 1.5f, false };
    auto batch = std::make_unique<MicrosurfaceBatch>();
    Rng rng(8);
    for (int i = 0; i < 250; ++i) {
      const Vec3 n = sample_isotropic(rng);
      batch->push(n, normalize(0.9 * sample_isotropic(rng) - n), rng.uniform2(), rng.bits());
    }
    Outcome& outcome = outcomes[hwy::TargetName(target)];
    outcome.shares.resize(250);
    batch->start(interface);
    while (batch->under_way() > 0) {
      batch->collide(interface, lights, 4);
      for (std::size_t i = 0; i < batch->lit().size; ++i)
        outcome.shares[batch->lit().slot[i]] += batch->lit().share[i];
      for (std::size_t i = 0; i < batch->sent().size; ++i)
        outcome.weights.push_back(batch->sent().weight[i]);
    }
    for (int i = 0; i < 250; ++i) outcome.inward.push_back(float(batch->inward_weight(i)));
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
  EXPECT_GE(outcomes.size(), 2u);
  // The same fused operations: the same request gives the same bits on both.
  if (outcomes.contains("AVX2") && outcomes.contains("AVX3")) {
    EXPECT_EQ(outcomes["AVX2"], outcomes["AVX3"]);
  }
  const auto sum = [](const std::vector<float>& values) {
    double s = 0;
    for (const float v : values) s += v;
    return s;
  };
  const Outcome& first = outcomes.begin()->second;
  for (const auto& [name, outcome] : outcomes) {
    EXPECT_NEAR(sum(outcome.weights), sum(first.weights), 0.05 * sum(first.weights)) << name;
    EXPECT_NEAR(sum(outcome.inward), sum(first.inward), 0.05 * sum(first.inward)) << name;
  }
}

}  // namespace
}  // namespace translucube::test
