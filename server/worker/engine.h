#pragma once

#include <functional>
#include <optional>
#include <stop_token>

#include "renderer/film/explorable_develop.h"
#include "renderer/render.h"

namespace translucube::server {

/// A scene that is ready to be traced, on this machine and by any number of threads.
struct TracedScene {
  std::function<std::optional<PassFilm>(const Pass&, int threads, const Patience&)> trace;
  std::function<RenderStats(const Film&, double seconds, int threads)> stats;
  std::optional<ExplorableBasis> explorable;  ///< of a scene whose film keeps the path lengths
};

/// What a worker asks of the renderer: tests put another in its place.
using Engine = std::function<TracedScene(const SceneSpec&)>;

/// The renderer itself. It keeps the environments that it has read last.
Engine renderer_engine();

}  // namespace translucube::server
