#include "server/endpoints.h"

namespace translucube::server {
namespace {

constexpr const char* problem_type = "application/problem+json";

}  // namespace

HttpResponse problem_response(const api::Problem& problem) {
  HttpResponse response{api::kind(problem.code).status, {}, problem_type, api::to_json(problem)};
  if (response.status == 503) response.headers.emplace_back("Retry-After", "5");
  return response;
}

HttpResponse plain_problem_response(int status, const std::string& title,
                                    const std::string& detail) {
  // Called with our own words only: nothing in them needs escaping.
  return {status,
          {},
          problem_type,
          R"({"type":"about:blank","title":")" + title + R"(","status":)" + std::to_string(status) +
              R"(,"detail":")" + detail + "\"}"};
}

}  // namespace translucube::server
