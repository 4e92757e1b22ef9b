// The renderer's crossing of a rough interface against the plain random walk of Heitz, Hanika,
// d'Eon, Dachsbacher 2016, section 4: in the space of heights, one ray at a time, nothing split,
// weighted or cut short.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "renderer/optics/microsurface.h"
#include "renderer/optics/microsurface_batch.h"
#include "tests/support/chi2.h"
#include "tests/support/microsurface.h"

namespace translucube::test {
namespace {

Vec3 mirrored(Vec3 w) { return {w.x, w.y, -w.z}; }

/// Where a ray from wo leaves, in wo's frame.
Vec3 plain_walk(double alpha, double eta, Vec3 wo, Rng& rng) {
  Vec3 d = -wo;      // of travel, in the frame of the side it is on
  double below = 1;  // share of heights below it
  bool beyond = false;
  while (true) {
    if (d.z < 0) {
      below *= std::pow(rng.uniform_positive(), 1 / (1 + smith_lambda(alpha, -d)));
    } else {
      below *= std::pow(rng.uniform_positive(), -1 / smith_lambda(alpha, d));
      if (below >= 1) return beyond ? mirrored(d) : d;
    }
    const Vec3 w = -d, m = Ggx{alpha}.sample_visible(w, rng.uniform2());
    if (rng.uniform() < fresnel(dot(w, m), eta)) {
      d = reflect(w, m);
    } else {
      d = mirrored(*refract(w, m, eta));
      below = 1 - below;
      beyond = !beyond;
      eta = 1 / eta;
    }
  }
}

/// Either side, five zones of the cosine, forwards and backwards.
constexpr int zones = 5, bins = 2 * zones * 2;
int bin_of(Vec3 wi) {
  const int zone = std::min(zones - 1, static_cast<int>(zones * std::fabs(wi.z)));
  return ((wi.z > 0 ? zones : 0) + zone) * 2 + (wi.x > 0);
}

struct Histogram {
  std::array<double, bins> sum{}, squares{};
  int walks = 0;

  void add(const std::array<double, bins>& walk) {
    for (int i = 0; i < bins; ++i) {
      sum[i] += walk[i];
      squares[i] += walk[i] * walk[i];
    }
    ++walks;
  }
  double mean(int i) const { return sum[i] / walks; }
  double variance_of_mean(int i) const { return (squares[i] / walks - mean(i) * mean(i)) / walks; }
};

/// The same with others of its kind, in SIMD.
void add_batch(Histogram& histogram, double alpha, double eta, Vec3 wo, std::uint64_t key) {
  std::array<std::array<double, bins>, MicrosurfaceBatch::capacity> walks{};
  auto batch = std::make_unique<MicrosurfaceBatch>();
  Rng rng(key);
  for (std::size_t i = 0; i < walks.size(); ++i)
    batch->push({0, 0, 1}, -wo, rng.uniform2(), rng.bits());
  const BatchInterface interface { static_cast<float>(alpha), static_cast<float>(eta) };
  batch->start(interface);
  while (batch->under_way() > 0) {
    batch->collide(interface, LightList(), 0);
    const MicrosurfaceBatch::Sent& sent = batch->sent();
    for (std::size_t i = 0; i < sent.size; ++i)
      walks[sent.slot[i]][bin_of(sent.direction[i])] += sent.weight[i];
  }
  for (std::size_t i = 0; i < walks.size(); ++i) {
    if (batch->inward_weight(i) > 0) walks[i][bin_of(batch->inward(i))] += batch->inward_weight(i);
    histogram.add(walks[i]);
  }
}

TEST(Microsurface, SendsLightWhereThePlainRandomWalkDoes) {
  constexpr int walks = 60'000;
  const std::array alphas{0.1, 0.4, 1.0};
  const std::array etas{1.5, 1 / 1.5}, cosines{0.9, 0.3};
  const double family = 2 * bins * alphas.size() * etas.size() * cosines.size();
  for (const double alpha : alphas)
    for (const double eta : etas)
      for (const double mu : cosines) {
        const Vec3 wo{std::sqrt(1 - mu * mu), 0, mu};
        Histogram plain, ours, batched;
        for (int i = 0; i < walks; ++i) {
          Rng rng(hash_combine(11, i));
          std::array<double, bins> walk{};
          walk[bin_of(plain_walk(alpha, eta, wo, rng))] = 1;
          plain.add(walk);
          // The sampler's stratified numbers would make the walks' errors smaller than told.
          PathSampler sampler(hash_combine(12, i), 0);
          walk = {};
          cross_microsurface(RoughInterface{1.5, Ggx{alpha}}, eta, wo, sampler,
                             [&](Vec3 wi, double weight) { walk[bin_of(wi)] += weight; });
          ours.add(walk);
        }
        while (batched.walks < walks)
          add_batch(batched, alpha, eta, wo, hash_combine(13, batched.walks));
        for (const Histogram* histogram : {&ours, &batched})
          for (int i = 0; i < bins; ++i) {
            const double error =
                std::sqrt(plain.variance_of_mean(i) + histogram->variance_of_mean(i));
            if (plain.mean(i) * walks < 30) continue;  // too few to be normal
            const double z = (histogram->mean(i) - plain.mean(i)) / error;
            EXPECT_GT(std::erfc(std::fabs(z) / std::sqrt(2.0)), sidak(static_cast<int>(family)))
                << (histogram == &ours ? "one by one" : "in batches") << " alpha " << alpha
                << " eta " << eta << " mu " << mu << " bin " << i << ": " << histogram->mean(i)
                << " for " << plain.mean(i) << " +- " << error;
          }
      }
}

}  // namespace
}  // namespace translucube::test
