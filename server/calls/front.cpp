#include "server/calls/front.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "api/openapi.h"
#include "server/base/log.h"
#include "server/http/problems.h"

namespace translucube::server {
namespace {

using api::ProblemCode;

/// Segment by segment; a segment of the pattern in braces stands for any.
bool matches(std::string_view pattern, std::string_view path) {
  while (!pattern.empty() && !path.empty()) {
    const std::size_t a = pattern.find('/', 1), b = path.find('/', 1);
    const std::string_view wanted = pattern.substr(0, a), given = path.substr(0, b);
    if (wanted != given && !(wanted.starts_with("/{") && given.size() > 1)) return false;
    pattern.remove_prefix(wanted.size());
    path.remove_prefix(given.size());
  }
  return pattern.empty() && path.empty();
}

}  // namespace

std::string_view route_pattern(std::string_view path) {
  static const std::vector<std::string> patterns = [] {
    std::vector<std::string> all;
    const auto document = nlohmann::json::parse(api::openapi_document());
    for (const auto& [pattern, item] : document["paths"].items()) all.push_back(pattern);
    return all;
  }();
  for (const std::string& pattern : patterns)
    if (matches(pattern, path)) return pattern;
  return "other";
}

Front::Front(AccessPolicy policy, Metrics& metrics, Respond endpoints)
    : policy_(std::move(policy)), metrics_(metrics), endpoints_(std::move(endpoints)) {}

HttpHandlers Front::handlers() {
  return {[this](HttpRequest& request) { return admit(request); },
          [this](const HttpRequest& request) { return respond(request); },
          [this](const RequestRecord& record) { done(record); }};
}

std::optional<HttpResponse> Front::admit(HttpRequest& request) const {
  auto admission = server::admit(policy_, request);
  if (!admission) return problem_response(admission.problem());
  request.client = std::move(admission->client);
  return std::nullopt;
}

HttpResponse Front::respond(const HttpRequest& request) const {
  if (request.path == "/metrics") return metrics_response(request);
  HttpResponse response = endpoints_(request);
  if (auto* stream = std::get_if<EventStream>(&response.body))
    stream->next = [next = std::move(stream->next), open = metrics_.open_stream()] {
      return next();
    };
  return response;
}

HttpResponse Front::metrics_response(const HttpRequest& request) const {
  if (request.method != "GET" && request.method != "HEAD") {
    HttpResponse response =
        problem_response({ProblemCode::method_not_allowed, "Allowed here: GET, HEAD", {}});
    response.headers.emplace_back("Allow", "GET, HEAD");
    return response;
  }
  return {200, {{"Cache-Control", "no-store"}}, Metrics::content_type, metrics_.text()};
}

void Front::done(const RequestRecord& record) const {
  const std::string_view route = route_pattern(record.path);
  metrics_.count_request(record.method.empty() ? "none" : record.method, route, record.status,
                         record.seconds);
  LogFields fields{{"id", record.id},
                   {"method", record.method},
                   {"path", record.path},
                   {"route", route},
                   {"status", std::int64_t(record.status)},
                   {"ms", record.seconds * 1e3},
                   {"bytes", static_cast<std::int64_t>(record.bytes)}};
  if (!record.client.empty()) fields.emplace_back("client", record.client);
  log_event(record.status >= 500 ? LogLevel::warn : LogLevel::info, fields);
}

}  // namespace translucube::server
