#pragma once

#include <stop_token>
#include <variant>

#include "server/worker/engine.h"

namespace translucube::server {

/// The film of a task's pass.
struct TracedPass {
  PassFilm film;
  double seconds = 0;    ///< wall clock of the tracing
  bool on_disk = false;  ///< its partial film is an artifact of the job already
};
/// The time that the render may take was over before the pass was.
struct OutOfTime {
  double seconds = 0;  ///< wall clock that the pass took until then
};
/// Somebody else wanted the pass to stop.
struct Stopped {};

/// Traces the pass of a task. It may run on any machine: it needs what the engine made of the job's
/// request, but no store, nor the films of other passes. `seconds_before`: wall clock of the passes
/// before, which a time target counts. `work` stops the tracing.
std::variant<TracedPass, OutOfTime, Stopped> trace(const TracedScene& scene, const Quality& quality,
                                                   const Pass& pass, double seconds_before,
                                                   int threads, std::stop_source work);

}  // namespace translucube::server
