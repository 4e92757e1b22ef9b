#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "server/worker/traced_job.h"
#include "server/worker/workshop.h"

namespace translucube::server {

/// What a worker has in hand: the scene and the film of its last job, so that the next task of the
/// same job starts at once.
struct Hand {
  std::string id;              ///< the job's; empty where there is none
  MemoryBudget::Share memory;  ///< first: given back when all else is freed
  TracedJob job;
  TracedScene scene;
  std::shared_ptr<LiveFilm> live = std::make_shared<LiveFilm>();
  double seconds = 0;  ///< wall clock of tracing, over all runs of the service
  double seconds_at_checkpoint = 0;
  double least_between_checkpoints = 0;  ///< [s]
  std::uint32_t unsaved_from = 0;  ///< pass from which on an explorable film is not on the disk

  const Film& film() const { return live->film; }
  bool is_at(const Task& task) const {
    return id == task.job_id && film().passes == task.pass.index;
  }
};

/// Makes the film of the passes before this one: from a worker that has it in hand just now, or
/// from the disk, where a checkpoint that was lost costs time, not the render. `seconds`: wall
/// clock of those passes. False where it was stopped on the way.
bool catch_up(Workshop& workshop, Hand& hand, const Pass& pass, double seconds,
              std::stop_token stop);

/// Writes the film where that is due, so that its passes need not be traced or merged again.
void keep_checkpoint(Workshop& workshop, Hand& hand);

/// Frees the memory. What is not on the disk of the job is written first.
void put_down(Workshop& workshop, Hand& hand);

}  // namespace translucube::server
