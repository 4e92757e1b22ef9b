#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/film/contribution_batch.h"
#include "renderer/film/film.h"
#include "renderer/scene/scene.h"
#include "renderer/transport/path.h"

namespace translucube {

/// Camera samples of a pixel that are in flight at once: a tile's paths then fit the L2 cache.
inline constexpr std::uint32_t samples_at_once = 4;

/// Where paths wait for their next stage.
struct PathQueues {
  std::vector<Path> arriving, walking, leaving;
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

/// Adds camera samples [first, first + count) of a pass to every pixel of the tile. `log`, where
/// given, receives a line for every event.
void trace_tile(const Scene& scene, std::uint32_t pass_index, std::uint32_t first,
                std::uint32_t count, Tile& tile, std::string* log = nullptr);

}  // namespace translucube
