#pragma once

#include <string>

#include "api/request/catalog.h"
#include "server/base/metrics.h"
#include "server/pictures/explorable_cache.h"
#include "server/pictures/live_films.h"
#include "server/store/artifact_store.h"
#include "server/store/job_store.h"
#include "server/worker/engine.h"

namespace translucube::server {

/// What the workers share; all of it outlives them.
struct Workshop {
  const api::Catalog& catalog;
  JobStore& store;
  ArtifactStore& artifacts;
  Metrics& metrics;
  LiveFilms& live_films;
  ExplorableCache& explorables;
  Engine engine;
  int threads = 0;  ///< for each render; 0: all cores

  int cores() const;  ///< of a render
};

/// Removes the files of a job that will never be asked for them: it failed, was canceled or
/// removed.
void tidy(Workshop& workshop, const std::string& job_id);

}  // namespace translucube::server
