#pragma once

#include <string>
#include <vector>

#include "server/worker/hand.h"

namespace translucube::server {

/// Develops and writes the pictures of all lanes of the film in hand. Throws FileError.
std::vector<StoredResult> write_results(Workshop& workshop, const Hand& hand, const Task& task,
                                        const std::string& stats);

/// Removes the files of results that the store did not take.
void discard_refused(Workshop& workshop, const std::vector<StoredResult>& results);

}  // namespace translucube::server
