#pragma once

// What the calls read of a request beside its body: the headers and query parameters that several
// of them know.

#include <optional>
#include <string>
#include <string_view>

#include "api/base/result.h"
#include "server/http/message.h"
#include "server/service/job_service.h"

namespace translucube::server {

/// The key of a submission, if it has one. Its body must be JSON.
api::Result<std::optional<std::string>> submission_key(const HttpRequest& request);

/// The query of a list: cursor, limit, status.
api::Result<ListQuery> list_query(const HttpRequest& request);

/// The longest that `Prefer: wait` and `?wait=` are honoured.
inline constexpr int longest_wait_s = 60;
/// The query's `wait` [s], 0 where it is not there, longest_wait_s at most.
api::Result<int> wait_query(const HttpRequest& request);

/// A query parameter that is true or false, and false where it is not there.
api::Result<bool> flag_query(const HttpRequest& request, std::string_view name);

}  // namespace translucube::server
