#include "server/service/page.h"

#include <string_view>

#include "server/base/ids.h"

namespace translucube::server {
namespace {

constexpr std::string_view cursor_prefix = "before-";

}  // namespace

api::Result<JobFilter> page_filter(const ListQuery& query) {
  JobFilter filter{query.state, std::nullopt, query.limit + 1};
  if (!query.cursor) return filter;
  const std::string_view cursor = *query.cursor;
  if (!cursor.starts_with(cursor_prefix) || !is_id(cursor.substr(cursor_prefix.size())))
    return api::Problem{api::ProblemCode::invalid_request,
                        "A query parameter is not valid.",
                        {{"?cursor", "not a cursor that this service gave"}}};
  filter.before_id = cursor.substr(cursor_prefix.size());
  return filter;
}

std::string cursor_behind(const std::string& id) { return std::string(cursor_prefix) + id; }

}  // namespace translucube::server
