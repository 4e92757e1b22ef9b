#include "server/http/message.h"

#include <algorithm>

namespace translucube::server {

HttpResponse problem_response(const api::Problem& problem) {
  HttpResponse response{
      api::kind(problem.code).status, {}, "application/problem+json", api::to_json(problem)};
  // RFC 9110, 15.5.2: a 401 says how to prove who one is.
  if (response.status == 401) response.headers.emplace_back("WWW-Authenticate", "Bearer");
  if (response.status == 429 || response.status == 503)
    response.headers.emplace_back("Retry-After", "5");
  return response;
}

std::string printable(std::string_view text) {
  std::string result(text.substr(0, 200));
  std::ranges::replace_if(
      result, [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return result;
}

}  // namespace translucube::server
