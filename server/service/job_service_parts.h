#pragma once

// What the parts of JobService (job_service*.cpp) share.

#include <spdlog/spdlog.h>

#include <type_traits>

#include "api/base/result.h"
#include "server/service/job_service.h"

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

/// The filter of a page, with one more than the page holds, or the problem of its cursor.
api::Result<JobFilter> page_filter(const ListQuery& query);
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
