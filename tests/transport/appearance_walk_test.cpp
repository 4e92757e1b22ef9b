// Slab optics: what must hold whatever the answer is, and the walks against each other.

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/slab/walk.h"
#include "tests/support/slabs.h"

namespace translucube::test {
namespace {

/// R + T - 1. Without absorption every history keeps its energy, rounding apart; only the part that
/// enters a smooth face at a sampled angle is known on the average alone; at an index near 1 that
/// average hangs on rare grazing angles.
void expect_energy(const SlabAppearance& s, bool smooth, const std::string& what) {
  EXPECT_NEAR(reflectance(s.normal) + transmittance(s.normal), 1, 1e-9) << what;
  const double error = std::hypot(reflectance_error(s.diffuse), transmittance_error(s.diffuse));
  EXPECT_NEAR(reflectance(s.diffuse) + transmittance(s.diffuse), 1,
              1e-9 + (smooth ? 4.5 * error + 1e-4 : 0))
      << what;
}

TEST(Energy, IsKeptBySmoothAndRoughSlabs) {
  for (const double alpha : {0.0, 0.05, 0.5, 1.0})
    for (const double sigma_s : {0.0, 0.2, 3.0, 40.0, 3000.0})
      for (const double g : {-0.9, 0.0, 0.9}) {
        if (sigma_s == 0 && g != 0) continue;
        const SlabAppearance s = measure(plate(1.5, alpha, sigma_s, 0, g), 5e-3);
        expect_energy(
            s, alpha == 0,
            std::to_string(alpha) + ' ' + std::to_string(sigma_s) + ' ' + std::to_string(g));
        EXPECT_LE(s.largest_standard_error, 5e-3);
      }
}

TEST(HardCases, KeepTheirEnergyAndEnd) {
  for (const double alpha : {0.0, 1e-4, 1.0})
    for (const double ior : {1.0, 1.0001, 4.0})
      for (const double sigma_s : {1e-6, 1.0, 1e6, 1e18})
        for (const double g : {-0.99, 0.99})
          expect_energy(measure(plate(ior, alpha, sigma_s, 0, g), 0.02), alpha == 0 || ior == 1,
                        std::to_string(alpha) + ' ' + std::to_string(ior) + ' ' +
                            std::to_string(sigma_s) + ' ' + std::to_string(g));
}

TEST(Jumps, AgreeWithTheAnalogWalk) {
  // Thick enough for jumps, thin enough for walking; lengths are compared through absorption.
  for (const double g : {0.0, 0.8, -0.5}) {
    const double sigma_s = 200 / (1 - g);
    const slab::Body body{SmoothInterface{1.5}, ScatteringInterior{Medium{sigma_s, g}}, 0};
    constexpr double peak = 1;  // 1 / thickness
    constexpr std::uint64_t n = 8'000;
    slab::Tally jumped(peak), walked(peak);
    slab::walk(body, slab::Incidence::diffuse, 1, 0, 4 * n, jumped);
    slab::walk_analog(body, slab::Incidence::diffuse, 2, 0, n, walked);
    for (const double sigma_a : {0.0, 0.001, 0.01, 0.1, 1.0})
      for (const slab::Exit exit : {slab::Exit::reflected, slab::Exit::wide}) {
        double with = 0, without = 0;
        for (std::size_t node = 0; node < slab::Tally::nodes; ++node) {
          const double left = std::exp(-sigma_a * slab::Tally::depth_at(node));
          with += jumped.weights(exit)[node] * left / (4 * n);
          without += walked.weights(exit)[node] * left / n;
        }
        // Each history brings at most about 1: a generous bound on its spread.
        const double share = exit == slab::Exit::reflected ? 1 - without : without;
        const double error = std::sqrt(std::fmax(share, 1e-4) * (1 + 1.0 / 4) / n);
        EXPECT_NEAR(with, without, 4 * error) << "g " << g << " sigma_a " << sigma_a;
      }
  }
}

TEST(DenseWhiteSlab, TransmitsAsDiffusionSays) {
  // Matched index, diffuse incidence, isotropic: T -> (4/3) / (tau + 2 x 0.71045) (van de Hulst
  // 1980, chapter 9, with Milne's extrapolation length).
  const SlabAppearance s = measure(plate(1, 0, 100), 1e-4);
  EXPECT_NEAR(transmittance(s.diffuse), 4.0 / 3 / (100 + 2 * 0.7104460896),
              4.5 * transmittance_error(s.diffuse));
  EXPECT_LT(transmittance_error(s.diffuse), 1.01e-4);
}

TEST(Developed, LightEqualsEachChannelTracedAlone) {
  // Three channels of one trace against three grey bodies, whose paths end by their own absorption.
  Material m = plate(1.5, 0, 20, 4);
  m.absorber = RgbAbsorber{{1, 0.1, 0}};
  const SlabAppearance together = measure(m, 1e-3);
  EXPECT_TRUE(together.normal.value.reflected.bands.empty());
  for (int c = 0; c < 3; ++c) {
    const double sigma_a = 4 * std::get<RgbAbsorber>(m.absorber).relative[c];
    const SlabAppearance alone = measure(plate(1.5, 0, 20, sigma_a), 1e-3, 2);
    const auto compare = [&](const SlabAppearance::AtIncidence& a,
                             const SlabAppearance::AtIncidence& b) {
      EXPECT_NEAR(a.value.reflected.total[c], b.value.reflected.total[0],
                  4 * std::hypot(a.standard_error.reflected.total[c], reflectance_error(b)) + 5e-6);
      EXPECT_NEAR(
          a.value.transmitted.total[c], b.value.transmitted.total[0],
          4 * std::hypot(a.standard_error.transmitted.total[c], transmittance_error(b)) + 5e-6);
    };
    compare(together.normal, alone.normal);
    compare(together.diffuse, alone.diffuse);
  }
}

}  // namespace
}  // namespace translucube::test
