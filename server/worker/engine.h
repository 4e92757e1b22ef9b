#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "renderer/light/environment_cache.h"
#include "renderer/render.h"

namespace translucube::server {

/// What a worker asks of the renderer, as values: tests put failures in its place.
struct Engine {
  std::function<std::shared_ptr<const Scene>(const SceneSpec&)> build =
      [environments = std::make_shared<EnvironmentCache>()](const SceneSpec& spec) {
        return build_scene(spec, environments.get());
      };
  std::function<std::optional<PassFilm>(const Scene&, const Pass&, int threads, std::stop_token)>
      trace = trace_pass;
  std::function<RenderStats(const Scene&, const Film&, double seconds, int threads)> stats =
      stats_of;
};

}  // namespace translucube::server
