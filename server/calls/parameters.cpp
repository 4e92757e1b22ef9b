#include "server/calls/parameters.h"

#include <algorithm>

#include "api/base/faults.h"
#include "api/base/text.h"
#include "server/base/ids.h"
#include "server/http/negotiation.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;

constexpr int default_page = 50, longest_page = 200;

std::optional<int> integer_in(std::string_view text, int low, int high) {
  const auto value = api::number_of<int>(text);
  return value && *value >= low && *value <= high ? value : std::nullopt;
}

}  // namespace

Result<std::optional<std::string>> submission_key(const HttpRequest& request) {
  const std::string_view type = request.header("content-type");
  if (!type.empty() && !is_json(type))
    return Problem{ProblemCode::unsupported_media_type,
                   "The body must be sent as Content-Type: application/json.",
                   {}};
  const auto it = request.headers.find("idempotency-key");
  if (it == request.headers.end()) return std::optional<std::string>();
  if (!is_idempotency_key(it->second))
    return Problem{ProblemCode::invalid_request,
                   "The Idempotency-Key must be 1 to 255 visible ASCII characters.",
                   {}};
  return std::optional(it->second);
}

Result<ListQuery> list_query(const HttpRequest& request) {
  ListQuery query{std::nullopt, request.parameter("cursor"), default_page};
  std::vector<api::Fault> faults;
  if (const auto status = request.parameter("status")) {
    query.state = api::job_state(*status);
    if (!query.state)
      faults.push_back({"?status", "must be one of queued, running, succeeded, failed, canceled"});
  }
  if (const auto text = request.parameter("limit")) {
    const auto limit = integer_in(*text, 1, longest_page);
    if (!limit) faults.push_back({"?limit", "must be an integer from 1 to 200"});
    query.limit = limit.value_or(default_page);
  }
  if (!faults.empty()) return api::invalid_query(std::move(faults));
  return query;
}

Result<int> wait_query(const HttpRequest& request) {
  const auto text = request.parameter("wait");
  if (!text) return 0;
  const auto seconds = integer_in(*text, 0, 1'000'000);
  if (!seconds) return api::invalid_query({{"?wait", "must be a number of seconds, 0 or more"}});
  return std::min(*seconds, longest_wait_s);
}

Result<bool> flag_query(const HttpRequest& request, std::string_view name) {
  const auto text = request.parameter(name);
  if (!text || *text == "false") return false;
  if (*text == "true") return true;
  return api::invalid_query({{'?' + std::string(name), "must be true or false"}});
}

}  // namespace translucube::server
