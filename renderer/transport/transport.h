#pragma once

// What the transport is called by. trace_tile() finds the shape, trace_body() (trace_body.inl) the
// interface and the interior: a tracer for each combination, compiled shape by shape in instances/.

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/base/patience.h"
#include "renderer/film/contribution_batch.h"
#include "renderer/film/film.h"
#include "renderer/scene/scene.h"
#include "renderer/transport/path.h"

namespace translucube {

/// Camera samples of a pixel that are in flight at once: a tile's paths then fit the L2 cache.
inline constexpr std::uint32_t samples_at_once = 4;

/// Camera samples [first, first + count) of a pass, for every pixel.
struct SampleRange {
  std::uint32_t pass_index, first, count;
};

/// Where paths wait for their next stage.
struct PathQueues {
  std::vector<Path> entering, walking, leaving;
  std::vector<Path> crossing;  ///< at the rough interface
};

/// A rectangle of pixels and what its paths bring; owned by one thread at a time.
struct Tile {
  std::uint32_t index = 0;  ///< of the image's tiles: seeds what the tile's paths share
  int x0 = 0, y0 = 0, width = 0, height = 0;
  std::vector<float> sum;  ///< lanes x height x width x pixel_floats
  TraceCounters counters;
  PathQueues queues;  ///< empty between calls; only their memory stays
};

template <class Shape>
void trace_body(const Shape& shape, const Scene& scene, const SampleRange& samples, Tile& tile,
                const Patience& patience, std::string* log);

/// Adds the samples to the tile, as far as they come before the patience is over. `log`, where
/// given, receives a line for every event.
inline void trace_tile(const Scene& scene, const SampleRange& samples, Tile& tile,
                       const Patience& patience, std::string* log = nullptr) {
  std::visit([&](const auto& shape) { trace_body(shape, scene, samples, tile, patience, log); },
             scene.shape);
}

}  // namespace translucube
