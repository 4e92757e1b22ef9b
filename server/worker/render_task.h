#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "api/base/problem.h"
#include "api/request/catalog.h"
#include "server/base/metrics.h"
#include "server/pictures/explorable_cache.h"
#include "server/pictures/live_films.h"
#include "server/store/artifact_store.h"
#include "server/store/job_store.h"
#include "server/worker/engine.h"
#include "server/worker/traced_job.h"

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
};

/// Works on claimed tasks, one at a time; keeps the scene and the merged film of the last job, so
/// that the next task of the same job starts at once.
class TaskRunner {
 public:
  explicit TaskRunner(Workshop& workshop) : workshop_(workshop) {}

  /// Traces the task's pass, stores and merges it, and ends the job or plans its next pass.
  /// Whatever fails ends in the store: as a failed job, or as a task to try again. `work` stops the
  /// tracing; the task is then given back. Does not throw.
  void run(const Task& task, std::stop_source work);
  /// Frees the memory of the last job. What is not on the disk of it is written first.
  void put_down();
  const std::string& job_in_hand() const { return hand_.id; }

 private:
  struct Hand {
    std::string id;
    TracedJob job;
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<LiveFilm> live = std::make_shared<LiveFilm>();
    double seconds = 0;  ///< wall clock of tracing, over all runs of the service
    double seconds_at_checkpoint = 0;
    double least_between_checkpoints = 0;  ///< [s]
    std::uint32_t unsaved_from = 0;  ///< pass from which on an explorable film is not on the disk

    const Film& film() const { return live->film; }
  };

  void run_or_throw(const Task& task, std::stop_source work);
  void forget();
  std::optional<Film> live_film(const Task& task) const;
  void keep_checkpoint();
  bool take_in_hand(const Task& task, const Job& job, std::stop_token stop);
  void finish(const Task& task, double task_seconds, bool with_pass);
  std::vector<StoredResult> write_pictures(const Task& task, const std::string& stats);
  void discard(const std::vector<StoredResult>& results);
  void fail(const Task& task, const api::Problem& problem);
  void retry_later(const Task& task, const std::string& reason);
  void tidy(const std::string& id);
  std::optional<std::uint32_t> total_samples() const;
  int threads() const;

  Workshop& workshop_;
  Hand hand_;
};

}  // namespace translucube::server
