// Adding and doubling against walks, and against itself at the ends of what it takes.

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/slab/adding.h"
#include "renderer/slab/walk.h"
#include "tests/support/slabs.h"

namespace translucube::test {
namespace {

struct SlabBody {
  slab::Channels channels;
  slab::Body body;

  explicit SlabBody(const Material& m)
      : channels(slab::make_channels(m, 1)),
        body{make_interface(m), make_interior(m, 1), channels.sigma_a[0]} {}
};

/// By walks without jumps, of so many histories.
slab::Readings walked(const SlabBody& b, slab::Incidence incidence, std::uint64_t histories) {
  constexpr int replicates = 32;
  const double sigma_a = b.channels.sigma_a[0];
  slab::Readings readings;
  readings.unwalked = read_unwalked(b.body, incidence, b.channels);
  slab::Developer developer(b.channels, sigma_a);
  for (std::uint64_t i = 0; i < replicates; ++i) {
    slab::Tally tally(sigma_a);
    slab::walk_analog(b.body, incidence, hash_combine(77, i), 0, histories / replicates, tally);
    readings.replicates.push_back(
        developer.develop(tally, static_cast<double>(histories / replicates)));
  }
  return readings;
}

Material grey(double ior, double alpha, double sigma_s, double sigma_a, double g) {
  Material m = plate(ior, alpha, sigma_s, sigma_a, g);
  m.absorber = RgbAbsorber{{1, 1, 1}};
  return m;
}

/// z of the totals, of haze and of clarity.
void expect_walks(const Material& m, std::uint64_t histories) {
  const SlabBody b(m);
  const auto added = add_layers(b.body, b.channels, 5e-4, 1, 0);
  ASSERT_TRUE(added);
  const auto compare = [&](const char* what, double a, double a_error, double w, double w_error) {
    EXPECT_NEAR(a, w, 4.5 * std::hypot(a_error, w_error))
        << what << ", ior " << m.ior << " alpha " << m.coefficients.alpha << " sigma_s "
        << m.coefficients.sigma_s << " g " << m.g;
  };
  for (const slab::Incidence incidence : slab::incidences) {
    const slab::Readings walks = walked(b, incidence, histories);
    const slab::Readings& sums = added->at[static_cast<int>(incidence)];
    const auto a = optics_of(sums), w = optics_of(walks);
    compare("R", reflectance(a), reflectance_error(a), reflectance(w), reflectance_error(w));
    compare("T", transmittance(a), transmittance_error(a), transmittance(w),
            transmittance_error(w));
    if (incidence == slab::Incidence::diffuse) continue;
    const auto haze = haze_of(sums), walked_haze = haze_of(walks);
    ASSERT_TRUE(haze && walked_haze);
    compare("haze", haze->value, haze->standard_error + 5e-4, walked_haze->value,
            walked_haze->standard_error);
  }
}

TEST(Adding, AgreesWithWalks) {
  expect_walks(grey(1.5, 0, 4, 0.3, 0), 40'000);
  expect_walks(grey(1.5, 0, 8, 0.5, 0.9), 20'000);
  expect_walks(grey(1.0, 0, 10, 0.2, 0.5), 20'000);
  expect_walks(grey(1.5, 0.3, 9, 0.3, 0), 20'000);
  expect_walks(grey(2.5, 1, 12, 0.2, 0.8), 10'000);
}

TEST(LongAdding, AgreesWithWalks) {
  for (const double alpha : {0.0, 0.1, 1.0})
    for (const double ior : {1.01, 1.5, 2.5})
      for (const double g : {-0.5, 0.5, 0.9}) expect_walks(grey(ior, alpha, 10, 0.3, g), 500'000);
}

TEST(Adding, LeavesToWalksWhatItDoesNotResolve) {
  const auto adds = [](const Material& m, double error) {
    const SlabBody b(m);
    return add_layers(b.body, b.channels, error, 1, 0).has_value();
  };
  EXPECT_TRUE(adds(grey(1.5, 0, 10, 0.1, 0), 1e-3));
  EXPECT_FALSE(adds(grey(1.5, 0, 1, 0.1, 0), 1e-3)) << "thin";
  EXPECT_FALSE(adds(grey(1.5, 0, 10, 0.1, 0.99), 1e-3)) << "scatters narrowly";
  EXPECT_FALSE(adds(grey(1.5, 0, 10, 0.1, -0.9), 1e-3)) << "scatters back narrowly";
  EXPECT_FALSE(adds(grey(1.5, 0, 10, 0.1, 0), 1e-5)) << "to be known better";
  EXPECT_FALSE(adds(grey(1.5, 0, 0, 0.1, 0), 1e-3)) << "empty";
}

TEST(Adding, ReflectsFromAHalfSpaceWhatChandrasekharSays) {
  // Matched index, isotropic, albedo 0.9: at normal incidence 1 - H(1) sqrt(1 - albedo)
  // (Chandrasekhar 1960, section 38) with H(1) from its integral equation, iterated.
  constexpr double albedo = 0.9;
  constexpr int n = 2000;
  std::vector<double> h(n + 1, 1);
  for (int step = 0; step < 60; ++step) {
    std::vector<double> next(n + 1);
    for (int i = 0; i <= n; ++i) {
      // 1 / H(mu) = sqrt(1 - albedo) + albedo / 2 int mu' H(mu') / (mu + mu') dmu'
      const double mu = static_cast<double>(i) / n;
      double integral = 0;
      for (int j = 0; j < n; ++j) {
        const double at = (j + 0.5) / n;
        integral += at * 0.5 * (h[j] + h[j + 1]) / (mu + at) / n;
      }
      next[i] = 1 / (std::sqrt(1 - albedo) + albedo / 2 * integral);
    }
    h = next;
  }
  const SlabAppearance s = measure(grey(1, 0, 1e5, 1e5 / 9, 0));
  EXPECT_NEAR(reflectance(s.normal), 1 - h[n] * std::sqrt(1 - albedo), 2e-5);
}

}  // namespace
}  // namespace translucube::test
