#pragma once

// Pearson's chi-squared test of a direction sampler against its density. The bins are polar about
// an axis, their polar angles in geometric progression down to a given width, so that a lobe of a
// thousandth of a radian is resolved as well as a hemisphere.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "renderer/base/vec.h"

namespace translucube::test {

struct Chi2Result {
  double statistic = 0;
  int degrees = 0;
  double p_value = 1;     ///< Wilson and Hilferty 1931
  double total_pdf = 0;   ///< integral of the density: the share of samples that there should be
  double total_seen = 0;  ///< share of samples that there were
};

inline double chi2_p_value(double statistic, int degrees) {
  const double k = degrees, v = 2 / (9 * k);
  const double z = (std::cbrt(statistic / k) - (1 - v)) / std::sqrt(v);
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

/// `draw` gives a direction or nothing; `pdf` is per solid angle and integrates to the share of
/// samples that are not nothing.
inline Chi2Result chi2_test(const std::function<std::optional<Vec3>()>& draw,
                            const std::function<double(Vec3)>& pdf, Vec3 axis, double width,
                            int samples) {
  constexpr int rings = 24, sectors = 12, fine = 64;
  const Frame frame(normalize(axis));
  std::vector<double> edges{0};
  for (int i = 0; i < rings; ++i)
    edges.push_back(std::numbers::pi * std::pow(width / std::numbers::pi, 1 - (i + 1.0) / rings));
  std::vector<double> seen(rings * sectors, 0), expected(rings * sectors, 0);
  for (int s = 0; s < samples; ++s) {
    const std::optional<Vec3> direction = draw();
    if (!direction) continue;
    const Vec3 w = frame.to_local(*direction);
    const double theta = std::atan2(std::hypot(w.x, w.y), w.z);
    const double phi = std::atan2(w.y, w.x) + std::numbers::pi;
    const auto ring =
        std::upper_bound(edges.begin() + 1, edges.end() - 1, theta) - edges.begin() - 1;
    const int sector =
        std::min(sectors - 1, static_cast<int>(phi / (2 * std::numbers::pi) * sectors));
    seen[ring * sectors + sector] += 1;
  }
  Chi2Result result;
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      double sum = 0;
      for (int i = 0; i < fine; ++i) {
        // Midpoints in theta; the solid angle of each strip is exact.
        const double a = edges[ring] + (edges[ring + 1] - edges[ring]) * i / fine;
        const double b = edges[ring] + (edges[ring + 1] - edges[ring]) * (i + 1) / fine;
        const double solid = 2 * std::sin((a + b) / 2) * std::sin((b - a) / 2) * 2 *
                             std::numbers::pi / (sectors * fine);
        for (int j = 0; j < fine; ++j) {
          const double theta = (a + b) / 2;
          const double phi =
              2 * std::numbers::pi * (sector + (j + 0.5) / fine) / sectors - std::numbers::pi;
          sum += solid * pdf(frame.to_world({std::sin(theta) * std::cos(phi),
                                             std::sin(theta) * std::sin(phi), std::cos(theta)}));
        }
      }
      expected[ring * sectors + sector] = sum * samples;
      result.total_pdf += sum;
      result.total_seen += seen[ring * sectors + sector] / samples;
    }
  // Bins too empty for the statistic are pooled (Cochran 1954).
  double pooled_seen = 0, pooled_expected = 0;
  const auto add = [&](double o, double e) {
    result.statistic += (o - e) * (o - e) / e;
    ++result.degrees;
  };
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (expected[i] >= 20) {
      add(seen[i], expected[i]);
    } else {
      pooled_seen += seen[i];
      pooled_expected += expected[i];
    }
  }
  if (pooled_expected >= 5) add(pooled_seen, pooled_expected);
  // Where nothing may be, nothing must be.
  if (pooled_expected < 5 && pooled_seen > 40) result.statistic += 1e9;
  result.degrees = std::max(1, result.degrees - 1);
  result.p_value = chi2_p_value(result.statistic, result.degrees);
  return result;
}

/// The level of one of `tests` tests for a family at 1 % (Sidak 1967).
inline double sidak(int tests) { return 1 - std::pow(0.99, 1.0 / tests); }

}  // namespace translucube::test
