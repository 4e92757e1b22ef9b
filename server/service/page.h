#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/base/result.h"
#include "server/store/job.h"

namespace translucube::server {

/// Which page of a list a client asks for.
struct ListQuery {
  std::optional<api::JobState> state;
  std::optional<std::string> cursor;
  int limit = 50;
};

/// The filter of a page, with one more than the page holds, or the problem of its cursor.
api::Result<JobFilter> page_filter(const ListQuery& query);

/// Names the page behind this id.
std::string cursor_behind(const std::string& id);

/// Cuts what is more than the page; the cursor of the next one if there is one.
template <typename Row>
std::optional<std::string> cut_page(std::vector<Row>& rows, int limit) {
  if (std::ssize(rows) <= limit) return std::nullopt;
  rows.resize(static_cast<std::size_t>(limit));
  return cursor_behind(rows.back().id);
}

}  // namespace translucube::server
