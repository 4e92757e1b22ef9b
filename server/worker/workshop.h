#pragma once

#include <string>

#include "api/request/catalog.h"
#include "server/base/metrics.h"
#include "server/pictures/explorable_cache.h"
#include "server/pictures/live_films.h"
#include "server/store/artifact_store.h"
#include "server/store/job_store.h"
#include "server/worker/engine.h"
#include "server/worker/memory_budget.h"
#include "server/worker/setbacks.h"

namespace translucube::server {

/// What the workers share; all of it outlives them.
struct Workshop {
  const api::Catalog& catalog;
  JobStore& store;
  ArtifactStore& artifacts;
  Metrics& metrics;
  LiveFilms& live_films;
  ExplorableCache& explorables;
  Setbacks& setbacks;
  MemoryBudget& memory;
  Engine engine;
  int retry_ms = 500;  ///< until a render that was set back is tried again, at first
  int threads = 0;  ///< for each render; 0: all cores

  int cores() const;  ///< of a render
};

/// Removes the films of a job that has ended or was removed: nobody asks for them again.
void tidy(Workshop& workshop, const std::string& job_id);

}  // namespace translucube::server
