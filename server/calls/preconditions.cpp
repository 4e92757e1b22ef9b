#include "server/calls/preconditions.h"

#include <algorithm>

#include "server/http/negotiation.h"

namespace translucube::server {
namespace {

std::string_view etag_of(const HttpResponse& answer) {
  const auto it = std::ranges::find(answer.headers, "ETag", [](const auto& h) { return h.first; });
  return it == answer.headers.end() ? std::string_view() : std::string_view(it->second);
}

bool succeeds(const HttpResponse& answer) { return answer.status >= 200 && answer.status < 300; }

HttpResponse failed(const char* header) {
  return problem_response(
      {api::ProblemCode::precondition_failed, std::string(header) + " does not allow it.", {}});
}

/// If-Match that no entity tag of what is there meets.
bool is_other(const HttpRequest& request, std::string_view etag) {
  return request.headers.contains("if-match") &&
         !etag_matches_strongly(request.header("if-match"), etag);
}

}  // namespace

bool has_precondition(const HttpRequest& request) {
  return request.headers.contains("if-match") || request.headers.contains("if-none-match");
}

HttpResponse conditional(const HttpRequest& request, HttpResponse answer) {
  const std::string etag(etag_of(answer));
  // A range is looked at last (RFC 9110, 13.2.2).
  const bool range_missed = answer.status == 416;
  if (!succeeds(answer) && !range_missed) return answer;
  if (is_other(request, etag)) return failed("If-Match");
  if (etag.empty() || !etag_matches(request.header("if-none-match"), etag)) return answer;
  HttpResponse unchanged{304, std::move(answer.headers), {}, {}};
  std::erase_if(unchanged.headers, [](const auto& h) { return h.first == "Content-Range"; });
  return unchanged;
}

std::optional<HttpResponse> unmet_precondition(const HttpRequest& request,
                                               const HttpResponse& current) {
  // Without it, the answer would be the same (RFC 9110, 13.2.1).
  if (!succeeds(current)) return std::nullopt;
  const std::string_view etag = etag_of(current);
  if (is_other(request, etag)) return failed("If-Match");
  if (etag_matches(request.header("if-none-match"), etag)) return failed("If-None-Match");
  return std::nullopt;
}

}  // namespace translucube::server
