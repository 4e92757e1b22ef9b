// Rough interfaces that scatter once, as the exact-transport peers have them (docs/speed.md), and
// what they lose against those that scatter as often as it takes.

#include "tests/support/peers.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "renderer/optics/lambertian.h"
#include "renderer/optics/microsurface.h"

namespace translucube::test {
namespace {

struct PeerMeans {
  double alpha, rgb[3], error;
};
void expect_means_of(const PeerMeans& peer, std::uint32_t samples, double largest_error) {
  SceneSpec spec = peer_scene({0, peer.alpha, 0}, 64, 1);
  spec.material.multiple_scattering = false;
  const std::array<Measured, 3> means = channel_means(trace(*build_scene(spec), samples));
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [mean, error] = means[c];
    std::printf("alpha %g channel %zu: %.5f +- %.5f, peers %.4f\n", peer.alpha, c, mean, error,
                peer.rgb[c]);
    EXPECT_NEAR(mean, peer.rgb[c], peer.error + 3 * error) << "channel " << c << " +- " << error;
    EXPECT_LT(error, largest_error);
  }
}

constexpr PeerMeans by_mitsuba_and_pbrt[] = {{.05, {.2268, .2304, .1827}, 3e-4},
                                             {.1, {.2220, .2250, .1778}, 3e-4},
                                             {.25, {.1952, .1976, .1526}, 5e-4}};

TEST(SingleScattering, HasTheMeansOfMitsubaAndPbrt) {
  for (const PeerMeans& peer : by_mitsuba_and_pbrt) expect_means_of(peer, 256, 5e-4);
}

TEST(LongSingleScattering, HasTheMeansOfMitsubaAndPbrt) {
  for (const PeerMeans& peer : by_mitsuba_and_pbrt) expect_means_of(peer, 4096, 1.2e-4);
}

/// Where one crossing of a rough interface sends a ray: Heitz et al. 2016 walked in the space of
/// heights (their C1, the share of the surface below, stands for the height) and dropped at the
/// second microfacet.
struct Crossing {
  bool kept, reflected;
  Vec3 wi;
};
double smith_lambda(double alpha, Vec3 w) {  // Walter 2007, eq. 34
  const double tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
  return 0.5 * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}
Crossing cross_once(double alpha, double eta, Vec3 wo, Rng& rng) {
  const double below = std::pow(rng.uniform_positive(), 1 / (1 + smith_lambda(alpha, wo)));
  const Vec3 m = Ggx{alpha}.sample_visible(wo, rng.uniform2());
  const bool reflected = rng.uniform() < fresnel(dot(wo, m), eta);
  const Vec3 wi = reflected ? reflect(wo, m) : *refract(wo, m, eta);
  if ((wi.z > 0) != reflected || wi.z == 0) return {false, reflected, wi};
  const double clear = std::pow(reflected ? below : 1 - below, smith_lambda(alpha, wi));
  return {rng.uniform() < clear, reflected, wi};
}

struct Share {
  double mean, standard_error;
};
Share share_of(int hits, int all) {
  const double p = double(hits) / all;
  return {p, std::sqrt(p * (1 - p) / all)};
}

TEST(SingleScattering, LosesAtACrossingWhatMeetsASecondMicrofacet) {
  constexpr int paths = 200'000;
  for (const double alpha : {0.05, 0.25, 1.0})
    for (const double eta : {1.5, 1 / 1.5})
      for (const double mu : {0.95, 0.5, 0.1}) {
        Rng rng(1);
        int kept = 0;
        const Vec3 wo{std::sqrt(1 - mu * mu), 0, mu};
        for (int i = 0; i < paths; ++i) kept += cross_once(alpha, eta, wo, rng).kept;
        const Share share = share_of(kept, paths);
        const DirectionalAlbedo a = directional_albedo({1.5, Ggx{alpha}, false}, eta, mu);
        // The albedo's 4096 stratified samples have the smaller part of the error.
        EXPECT_NEAR(a.reflected + a.transmitted, share.mean, 4 * share.standard_error + 1e-3)
            << "alpha " << alpha << " eta " << eta << " mu " << mu;
      }
}

/// Share of parallel light on a clear sphere that a scatter-once interface lets out again.
Share kept_by_a_sphere(double alpha, double ior, int paths) {
  int kept = 0;
  for (int i = 0; i < paths; ++i) {
    Rng rng(hash_combine(5, i));
    Vec3 n{0, 0, 1};
    Vec3 wo = InterfacedLambertian::sample(rng.uniform2());
    Crossing crossing = cross_once(alpha, ior, wo, rng);
    if (crossing.kept && crossing.reflected) ++kept;
    if (!crossing.kept || crossing.reflected) continue;
    Vec3 d = Frame(n).to_world(crossing.wi);
    while (true) {
      n = normalize(n - 2 * dot(n, d) * d);  // the far end of the chord
      crossing = cross_once(alpha, 1 / ior, Frame(-n).to_local(-d), rng);
      if (!crossing.kept) break;
      if (!crossing.reflected) {
        ++kept;
        break;
      }
      d = Frame(-n).to_world(crossing.wi);
    }
  }
  return share_of(kept, paths);
}

TEST(SingleScattering, DiffersFromMultipleByTheEnergyThatItLoses) {
  constexpr double covered = std::numbers::pi / 4;  // by the sphere, of the image
  for (const double alpha : {0.05, 0.1, 0.25, 0.5, 1.0}) {
    Measured means[2];
    for (const bool multiple : {false, true}) {
      Scene scene = body(Sphere{}, material(1.5, alpha, 0));
      std::get<RoughInterface>(scene.interface).multiple_scattering = multiple;
      look_from_afar(scene, 1.0, 64);
      means[multiple] = image_mean(trace(scene, 64));
    }
    const double lost = (means[1].mean - means[0].mean) / covered;
    const Share kept = kept_by_a_sphere(alpha, 1.5, 300'000);
    const double error = std::hypot(means[0].standard_error / covered,
                                    means[1].standard_error / covered, kept.standard_error);
    EXPECT_NEAR(lost, 1 - kept.mean, 4 * error) << "alpha " << alpha;
    EXPECT_LT(error, 2e-3) << alpha;
    std::printf("alpha %g: kept %.4f, lost %.4f, together 1 +- %.4f\n", alpha, kept.mean, lost,
                error);
  }
}

}  // namespace
}  // namespace translucube::test
