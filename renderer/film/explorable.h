#pragma once

// Explorable films keep the path lengths: each bin holds the light of one length inside the body,
// so that any absorber of any spectrum is developed later as the sum over bins of M(l_j) H_j. Light
// between two lengths is spread over four bins by the weights of cubic interpolation: what is
// interpolated is exp(-sigma l), for all sigma at once.

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "picture/image.h"
#include "renderer/base/vec.h"
#include "renderer/film/absorption.h"
#include "renderer/film/film.h"

namespace translucube {

/// What is never inside the body is in bin 0. Bin 1 is the limit of short lengths: it differs from
/// bin 0 for an absorber of infinite density only, which blackens all that was inside. The nodes
/// behind it are log-spaced. All lengths in the body's unit.
struct ExplorableBins {
  static constexpr int before_nodes = 2;

  double first = 0.003, last = 300;  ///< first and last node
  int nodes = 32;                    ///< >= 4

  int count() const { return before_nodes + nodes; }
  /// log of the ratio of neighbouring nodes.
  double step() const { return std::log(last / first) / (nodes - 1); }
  double length(int bin) const;
  friend bool operator==(const ExplorableBins&, const ExplorableBins&) = default;
};

/// The length of light that enters the body and leaves it where it entered.
inline constexpr double shortest_length = std::numeric_limits<double>::min();

/// The bins for absorption up to `densest` and scattering [1/unit]; 32 nodes from 0.003 to 300
/// where bodies are neither large nor dense, more of the same step where they are.
ExplorableBins explorable_bins(double densest, double sigma_s);

/// Four neighbouring bins and their weights, which add up to 1.
struct BinWeights {
  int bin = 0;
  std::array<float, 4> weights{1, 0, 0, 0};
};

/// Spreads lengths over bins.
class BinSpread {
 public:
  BinSpread() : BinSpread(ExplorableBins{}) {}
  explicit BinSpread(const ExplorableBins& bins);
  const ExplorableBins& bins() const { return bins_; }
  /// length >= 0, not NaN. Between nodes cubic in log length (at the ends the stencil is the last
  /// that fits); below the first node cubic in the length, over bin 1 and the first three nodes;
  /// from the last node on all in the last bin.
  BinWeights operator()(double length) const;

  // For those that spread many at a time.
  double log_first() const { return log_first_; }
  double inverse_step() const { return inverse_step_; }
  const std::array<float, 3>& short_nodes() const { return short_nodes_; }

 private:
  ExplorableBins bins_;
  double log_first_, inverse_step_;
  std::array<float, 3> short_nodes_;  ///< the first three nodes relative to the first
};

/// An explorable film as it is kept: half floats (IEEE 754 binary16), a power of two apart from the
/// radiance so that neither a sun overflows nor a dim bin vanishes.
struct ExplorableFilm {
  int width = 0, height = 0;
  ExplorableBins bins;
  double unit_mm = 1;
  std::vector<float> scales;          ///< a bin: radiance = scale x half, a power of two
  std::vector<std::uint16_t> halves;  ///< bins x 3 x height x width
};

/// Expects a film whose lanes are these bins.
ExplorableFilm explorable_film(const ExplorableBins& bins, double unit_mm, const Film& film);

/// The picture through an absorber (lengths in the body's unit). The bits do not depend on
/// `threads` (0: all cores).
Image develop_explorable(const ExplorableFilm& film, const Lane& lane, int threads = 0);
/// `sigma_a_peak` [1/mm], may be infinite.
Image develop_explorable(const ExplorableFilm& film, const Absorber& absorber, double sigma_a_peak,
                         int threads = 0);

/// A film that is still being traced, as the float sums stand: no halves are made of it.
Image develop_shares(const ExplorableBins& bins, const Film& film, const Lane& lane);

/// Compressed multi-channel EXR of half floats: a layer of R, G and B for each bin; the lengths,
/// the scales, the unit and the canonical request in its header. Throw ImageError.
void write_explorable(const std::filesystem::path& file, const ExplorableFilm& film,
                      const std::string& canonical_request);
struct StoredExplorable {
  ExplorableFilm film;
  std::string request;
};
StoredExplorable read_explorable(const std::filesystem::path& file);

}  // namespace translucube
