#include "server/calls/handlers.h"

#include <algorithm>
#include <charconv>

#include "server/base/ids.h"
#include "server/http/negotiation.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;

constexpr int default_page = 50, longest_page = 200;

/// The whole text as an integer from `low` to `high`.
std::optional<int> integer_in(const std::string& text, int low, int high) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end || value < low || value > high) return std::nullopt;
  return value;
}

}  // namespace

HttpResponse json_response(int status, std::string body) {
  return {status, {}, "application/json", std::move(body)};
}

HttpResponse tagged_json(const HttpRequest& request, const std::string& body) {
  return tagged_json(request, body, '"' + content_hash(body) + '"');
}

HttpResponse tagged_json(const HttpRequest& request, const std::string& body,
                         const std::string& etag) {
  HttpResponse response = etag_matches(request.header("if-none-match"), etag)
                              ? HttpResponse{304, {}, {}, {}}
                              : json_response(200, body);
  response.headers = {{"ETag", etag}, {"Cache-Control", "no-cache"}};
  return response;
}

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
  ListQuery query{std::nullopt, std::nullopt, default_page};
  Problem problem{ProblemCode::invalid_request, "A query parameter is not valid.", {}};
  for (const auto& [name, value] : request.query) {
    if (name == "cursor") query.cursor = value;
    if (name == "status") {
      query.state = api::job_state(value);
      if (!query.state)
        problem.faults.push_back(
            {"?status", "must be one of queued, running, succeeded, failed, canceled"});
    }
    if (name == "limit") {
      const auto limit = integer_in(value, 1, longest_page);
      if (!limit) problem.faults.push_back({"?limit", "must be an integer from 1 to 200"});
      query.limit = limit.value_or(default_page);
    }
  }
  if (!problem.faults.empty()) return problem;
  return query;
}

Result<int> wait_query(const HttpRequest& request) {
  for (const auto& [name, value] : request.query) {
    if (name != "wait") continue;
    const auto seconds = integer_in(value, 0, 1'000'000);
    if (!seconds)
      return Problem{ProblemCode::invalid_request,
                     "A query parameter is not valid.",
                     {{"?wait", "must be a number of seconds, 0 or more"}}};
    return std::min(*seconds, longest_wait_s);
  }
  return 0;
}

}  // namespace translucube::server
