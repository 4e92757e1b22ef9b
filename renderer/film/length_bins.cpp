#include "renderer/film/length_bins.h"

#include <algorithm>

#include "renderer/base/lagrange.h"

namespace translucube {

double LengthBins::length(int bin) const {
  if (bin == 0) return 0;
  if (bin == 1) return shortest_length;
  return first * std::exp((bin - before_nodes) * step());
}

LengthBins length_bins(double densest, double sigma_s) {
  const LengthBins usual{};
  // Below the first node exp(-sigma l) is interpolated by a cubic: 1e-4 of it up to sigma l = 0.4.
  // It may miss more where hardly any light is that short: only scattering turns light back early,
  // a share of about sigma_s l.
  const double shortest = std::max(0.4 / densest, 1e-3 / sigma_s);
  // Light leaves a diffusing unit sphere by exp(-3.3 l / sigma_s) and (sigma_s l)^(-1/2), whichever
  // is faster: a thousandth is left beyond this.
  const double longest = std::min(3 * sigma_s, 1e7 / sigma_s);
  // Whole steps, and not without end: eight decades to either side hold any body that is told from
  // a black one.
  const double step = usual.step(), most = std::log(1e8) / step;
  const auto steps = [&](double ratio) {
    return std::isnan(ratio) ? 0.0 : std::ceil(std::clamp(std::log(ratio) / step, 0.0, most));
  };
  const double below = steps(usual.first / shortest), above = steps(longest / usual.last);
  return {usual.first * std::exp(-below * step), usual.last * std::exp(above * step),
          usual.nodes + static_cast<int>(below + above)};
}

BinSpread::BinSpread(const LengthBins& bins)
    : bins_(bins), log_first_(std::log(bins.first)), inverse_step_(1 / bins.step()) {
  for (int i = 0; i < 3; ++i) short_nodes_[i] = static_cast<float>(std::exp(i * bins.step()));
}

namespace {

/// The weights from this bin on, the second of them what rounding leaves of 1.
BinWeights adding_up(int bin, std::array<float, 4> weights) {
  weights[1] = 1 - (weights[0] + weights[2] + weights[3]);
  return {bin, weights};
}

}  // namespace

BinWeights BinSpread::operator()(double length) const {
  if (length == 0) return {};
  if (length < bins_.first) {
    const std::array<float, 4> nodes{0, short_nodes_[0], short_nodes_[1], short_nodes_[2]};
    return adding_up(1, lagrange_weights<float>(nodes, static_cast<float>(length / bins_.first)));
  }
  const double position =
      std::min((std::log(length) - log_first_) * inverse_step_, double(bins_.nodes - 1));
  const int node = std::clamp(static_cast<int>(position) - 1, 0, bins_.nodes - 4);
  const auto t = static_cast<float>(position - node);
  // Lagrange's weights at 0, 1, 2, 3, where all divisors are known.
  const float a = t - 1, b = t - 2, c = t - 3;
  return adding_up(LengthBins::before_nodes + node,
                   {a * b * c * (-1.0f / 6), 0, t * a * c * -0.5f, t * a * b * (1.0f / 6)});
}

}  // namespace translucube
