#include "server/calls/front.h"

#include <algorithm>
#include <array>
#include <utility>

#include "server/base/log.h"
#include "server/calls/router.h"

namespace translucube::server {
namespace {

using api::ProblemCode;

constexpr std::string_view metrics_path = "/metrics";

/// Few, whatever clients send.
std::string_view method_label(std::string_view method) {
  constexpr std::array<std::string_view, 7> known{"GET",    "HEAD",  "POST",   "PUT",
                                                  "DELETE", "PATCH", "OPTIONS"};
  if (method.empty()) return "none";
  return std::ranges::find(known, method) == known.end() ? "other" : method;
}

}  // namespace

std::string_view route_of(std::string_view path) {
  const std::string_view pattern = path == metrics_path ? metrics_path : route_pattern(path);
  return pattern.empty() ? "other" : pattern;
}

Front::Front(AccessPolicy policy, Metrics& metrics, Respond respond, Receive receive)
    : policy_(std::move(policy)),
      metrics_(metrics),
      respond_(std::move(respond)),
      receive_(std::move(receive)) {}

HttpHandlers Front::handlers() {
  return {[this](HttpRequest& request) { return admit(request); },
          [this](const HttpRequest& request) { return respond(request); },
          // Metrics too: they are looked at when there is too much to do.
          [](const HttpRequest& request) {
            return is_probe(request.path) || request.path == metrics_path;
          },
          [this](const RequestRecord& record) { done(record); }};
}

std::optional<HttpResponse> Front::admit(HttpRequest& request) const {
  auto admission = server::admit(policy_, request);
  if (!admission) return problem_response(admission.problem());
  request.client = std::move(admission->client);
  return receive_(request);
}

HttpResponse Front::respond(const HttpRequest& request) const {
  if (request.path == metrics_path) return metrics_response(request);
  HttpResponse response = respond_(request);
  if (auto* stream = std::get_if<EventStream>(&response.body))
    stream->next = [next = std::move(stream->next), open = metrics_.open_stream()] {
      return next();
    };
  return response;
}

HttpResponse Front::metrics_response(const HttpRequest& request) const {
  if (request.method != "GET" && request.method != "HEAD") {
    HttpResponse response =
        request.method == "OPTIONS"
            ? HttpResponse{204, {}, {}, {}}
            : problem_response({ProblemCode::method_not_allowed, "Allowed here: GET, HEAD", {}});
    response.headers.emplace_back("Allow", "GET, HEAD");
    return response;
  }
  const Places::Place scrape = scrapes_.take();
  if (!scrape)
    return problem_response({ProblemCode::overloaded, "Too many ask for the metrics.", {}});
  return {200, {{"Cache-Control", "no-store"}}, Metrics::content_type, metrics_.text()};
}

void Front::done(const RequestRecord& record) const {
  const std::string_view route = route_of(record.path);
  metrics_.count_request(method_label(record.method), route, record.status, record.seconds);
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
