#pragma once

#include "server/worker/hand.h"
#include "server/worker/trace.h"

namespace translucube::server {

/// Takes the film of a task's pass, which is the next of the film in hand: merges it and tells the
/// store what follows, the next pass or the end of the job with its results. False where the hand
/// is of no more use: the job has ended, or the claim was lost. Throws RenderFailure, StoreError,
/// FileError.
bool accept(Workshop& workshop, Hand& hand, const Task& task, TracedPass pass);

/// The job ends with the passes that the hand has, without that of the task: its time is over.
void end_without(Workshop& workshop, Hand& hand, const Task& task, OutOfTime pass);

}  // namespace translucube::server
