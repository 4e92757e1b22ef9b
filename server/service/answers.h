#pragma once

// From what the store says to what a client is told.

#include <spdlog/spdlog.h>

#include <optional>
#include <type_traits>

#include "api/base/job_state.h"
#include "api/base/result.h"
#include "server/base/clock.h"
#include "server/base/file.h"
#include "server/store/store_error.h"

namespace translucube::server {

/// Runs `work`; what the disk refuses becomes a problem that tells a client no inner detail.
template <typename Work>
std::invoke_result_t<Work> guarded(Work&& work) {
  try {
    return work();
  } catch (const StoreError& error) {
    spdlog::error("{}", error.what());
  } catch (const FileError& error) {
    spdlog::error("{}", error.what());
  }
  return api::Problem{
      api::ProblemCode::storage_failure, "The disk of the service is full or cannot be used.", {}};
}

/// What the status of a render, that of a sweep and a sweep's summary have in common.
template <typename Status, typename Stored>
Status status_from(const Stored& stored) {
  Status status;
  status.id = stored.id;
  status.state = stored.state;
  status.created_at = rfc3339(stored.created_ms);
  if (stored.started_ms) status.started_at = rfc3339(*stored.started_ms);
  if (stored.finished_ms) status.finished_at = rfc3339(*stored.finished_ms);
  return status;
}

/// The state of a picture as a problem, where it has none to show.
std::optional<api::Problem> no_picture(api::JobState state);

}  // namespace translucube::server
