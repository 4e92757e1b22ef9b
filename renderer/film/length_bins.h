#pragma once

// Bins of the length of light inside the body: where an explorable film keeps its light. Light
// between two lengths is spread over four bins by the weights of cubic interpolation: what is
// interpolated is exp(-sigma l), for all sigma at once.

#include <array>
#include <cmath>
#include <limits>

namespace translucube {

/// What is never inside the body is in bin 0. Bin 1 is the limit of short lengths: it differs from
/// bin 0 for an absorber of infinite density only, which blackens all that was inside. The nodes
/// behind it are log-spaced. All lengths in the body's unit.
struct LengthBins {
  static constexpr int before_nodes = 2;

  double first = 0.003, last = 300;  ///< first and last node
  int nodes = 32;                    ///< >= 4

  int count() const { return before_nodes + nodes; }
  /// log of the ratio of neighbouring nodes.
  double step() const { return std::log(last / first) / (nodes - 1); }
  double length(int bin) const;
  friend bool operator==(const LengthBins&, const LengthBins&) = default;
};

/// The length of light that enters the body and leaves it where it entered.
inline constexpr double shortest_length = std::numeric_limits<double>::min();

/// The bins for absorption up to `densest` and scattering [1/unit]; 32 nodes from 0.003 to 300
/// where bodies are neither large nor dense, more of the same step where they are.
LengthBins length_bins(double densest, double sigma_s);

/// Four neighbouring bins and their weights, which add up to 1.
struct BinWeights {
  int bin = 0;
  std::array<float, 4> weights{1, 0, 0, 0};
};

/// Spreads lengths over bins.
class BinSpread {
 public:
  BinSpread() : BinSpread(LengthBins{}) {}
  explicit BinSpread(const LengthBins& bins);
  const LengthBins& bins() const { return bins_; }
  /// length >= 0, not NaN. Between nodes cubic in log length (at the ends the stencil is the last
  /// that fits); below the first node cubic in the length, over bin 1 and the first three nodes;
  /// from the last node on all in the last bin.
  BinWeights operator()(double length) const;

  // What those read who spread many at a time.
  double log_first() const { return log_first_; }
  double inverse_step() const { return inverse_step_; }
  const std::array<float, 3>& short_nodes() const { return short_nodes_; }

 private:
  LengthBins bins_;
  double log_first_, inverse_step_;
  std::array<float, 3> short_nodes_;  ///< the first three nodes relative to the first
};

}  // namespace translucube
