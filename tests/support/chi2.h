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

/// Bins about an axis: rings of polar angle, in geometric progression down to about `width`, each of
/// several sectors of azimuth.
class PolarBins {
 public:
  static constexpr int rings = 24, sectors = 12, count = rings * sectors;

  PolarBins(Vec3 axis, double width) : frame_(normalize(axis)) {
    for (int i = 0; i < rings; ++i)
      edges_.push_back(pi * std::pow(width / pi, 1 - (i + 1.0) / rings));
  }

  int bin_of(Vec3 direction) const {
    const Vec3 w = frame_.to_local(direction);
    const double theta = std::atan2(std::hypot(w.x, w.y), w.z);
    const double phi = std::atan2(w.y, w.x) + pi;
    const auto ring =
        std::upper_bound(edges_.begin() + 1, edges_.end() - 1, theta) - edges_.begin() - 1;
    const int sector = std::min(sectors - 1, static_cast<int>(phi / (2 * pi) * sectors));
    return static_cast<int>(ring) * sectors + sector;
  }

  /// By midpoints; the solid angle of each strip in theta is exact.
  double integral(const std::function<double(Vec3)>& pdf, int bin) const {
    constexpr int fine = 64;
    const double low = edges_[bin / sectors], step = (edges_[bin / sectors + 1] - low) / fine;
    double sum = 0;
    for (int i = 0; i < fine; ++i) {
      const double theta = low + (i + 0.5) * step;
      const double solid = 2 * std::sin(theta) * std::sin(step / 2) * 2 * pi / (sectors * fine);
      for (int j = 0; j < fine; ++j) {
        const double phi = 2 * pi * (bin % sectors + (j + 0.5) / fine) / sectors - pi;
        sum += solid * pdf(frame_.to_world({std::sin(theta) * std::cos(phi),
                                            std::sin(theta) * std::sin(phi), std::cos(theta)}));
      }
    }
    return sum;
  }

 private:
  static constexpr double pi = std::numbers::pi;
  Frame frame_;
  std::vector<double> edges_{0};
};

/// Pearson's statistic; bins too empty for it are pooled (Cochran 1954).
inline void compare_counts(Chi2Result& result, const std::vector<double>& seen,
                           const std::vector<double>& expected) {
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
}

/// `draw` gives a direction or nothing; `pdf` is per solid angle and integrates to the share of
/// samples that are not nothing.
inline Chi2Result chi2_test(const std::function<std::optional<Vec3>()>& draw,
                            const std::function<double(Vec3)>& pdf, Vec3 axis, double width,
                            int samples) {
  const PolarBins bins(axis, width);
  std::vector<double> seen(PolarBins::count, 0), expected(PolarBins::count, 0);
  Chi2Result result;
  for (int s = 0; s < samples; ++s)
    if (const std::optional<Vec3> direction = draw()) {
      ++seen[bins.bin_of(*direction)];
      result.total_seen += 1.0 / samples;
    }
  for (int bin = 0; bin < PolarBins::count; ++bin) {
    const double share = bins.integral(pdf, bin);
    expected[bin] = share * samples;
    result.total_pdf += share;
  }
  compare_counts(result, seen, expected);
  return result;
}

/// The level of one of `tests` tests for a family at 1 % (Sidak 1967).
inline double sidak(int tests) { return 1 - std::pow(0.99, 1.0 / tests); }

}  // namespace translucube::test
