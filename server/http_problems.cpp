#include "server/endpoints.h"

namespace translucube::server {

HttpResponse problem_response(const api::Problem& problem) {
  HttpResponse response{
      api::kind(problem.code).status, {}, "application/problem+json", api::to_json(problem)};
  if (response.status == 503 || response.status == 429)
    response.headers.emplace_back("Retry-After", "5");
  return response;
}

}  // namespace translucube::server
