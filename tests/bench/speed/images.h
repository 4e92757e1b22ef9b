#pragma once

// Renders of the peers' scene and what their noise is worth.

#include <vector>

#include "renderer/render.h"
#include "tests/bench/speed/figures.h"
#include "tests/support/relative_mse.h"

namespace translucube::speed {

using test::mean_of, test::reference_of, test::rel_mse, test::rel_mse_of_pair, test::RelMse;
using test::peer_material, test::peer_materials, test::peer_scene, test::PeerMaterial;

// Columns of several tables.
inline constexpr Quantity ns_a_sample{"ns a sample", "%.0f"}, flights{"flights", "%.2f", 0.02},
    connections{"connections", "%.2f", 0.02}, cpu_seconds{"CPU s", "%.3f"},
    untrimmed_cost{"untrimmed × CPU s"};

/// The reference thickness of the service's default sphere [mm].
inline constexpr double reference_mm = 10;

/// What a render is after some of its samples.
struct Snapshot {
  std::uint32_t samples = 0;  ///< of a pixel
  double cpu_seconds = 0;
  Image image;
};
/// One render, looked at on the way, at the first pass that reaches each of these samples (rising).
std::vector<Snapshot> trace(const Scene& scene, const std::vector<std::uint32_t>& samples,
                            int threads, TraceCounters* counters = nullptr);

/// Over all pixels and channels of images of one size.
double mean_value(const std::vector<Image>& images);
/// The largest pixel over its converged value, of those bright enough to be seen (of at least
/// 0.01).
double largest_ratio(const Image& image, const Image& converged);

/// Two independent renders of a spec, and what they cost.
struct Pair {
  Image a, b;
  double cpu_seconds = 0;  ///< of one
  TraceCounters counters;  ///< of one
  std::uint32_t samples = 0;
  Coefficients coefficients;

  RelMse error() const;
  double ns_per_sample() const {
    return 1e9 * cpu_seconds / static_cast<double>(counters.camera_samples);
  }
};
Pair render_pair(Run& run, SceneSpec spec, std::uint32_t samples);

}  // namespace translucube::speed
