#include "server/worker/engine.h"

#include <memory>

#include "renderer/light/environment_cache.h"

namespace translucube::server {

Engine renderer_engine() {
  return [environments = std::make_shared<EnvironmentCache>()](const SceneSpec& spec) {
    const std::shared_ptr<const Scene> scene = build_scene(spec, environments.get());
    return TracedScene{[scene](const Pass& pass, int threads, const Patience& patience) {
                         return trace_pass(*scene, pass, threads, patience);
                       },
                       [scene](const Film& film, double seconds, int threads) {
                         return stats_of(*scene, film, seconds, threads);
                       },
                       explorable_basis(*scene)};
  };
}

}  // namespace translucube::server
