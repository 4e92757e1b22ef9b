#pragma once

// What the parts of JobService (job_service*.cpp) share.

#include <spdlog/spdlog.h>

#include "server/service/job_service.h"

namespace translucube::server {

/// Runs `work`; what the disk refuses becomes a problem that tells a client no inner detail.
template <typename T, typename Work>
T guarded(Work&& work) {
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

/// The refusals of a store's submit, or what was submitted.
template <typename Stored>
Result<Submitted<Stored>> accepted(SubmitOutcome<Stored> outcome) {
  if (std::holds_alternative<IdempotencyMismatch>(outcome))
    return api::Problem{api::ProblemCode::idempotency_mismatch,
                        "This Idempotency-Key came before, with another request.",
                        {}};
  if (std::holds_alternative<QueueFull>(outcome))
    return api::Problem{
        api::ProblemCode::queue_full, "The queue has no room for this; try again later.", {}};
  return std::get<Submitted<Stored>>(std::move(outcome));
}

/// The filter of a page, with one more than the page holds, or the problem of its cursor.
Result<JobFilter> page_filter(const ListQuery& query);
/// Cuts what is more than the page; the cursor of the next one if there is one.
template <typename Row>
std::optional<std::string> cut_page(std::vector<Row>& rows, int limit) {
  if (std::ssize(rows) <= limit) return std::nullopt;
  rows.resize(static_cast<std::size_t>(limit));
  return "before-" + rows.back().id;
}

/// The picture's state as a problem, where it has none.
std::optional<api::Problem> no_picture(api::JobState state);

}  // namespace translucube::server
