#include "server/http/message.h"

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

std::string wire_text(const HttpResponse& response) {
  const std::string& body = std::get<std::string>(response.body);
  // RFC 9112, 4: the reason phrase may be empty.
  std::string text = "HTTP/1.1 " + std::to_string(response.status) + " \r\n";
  for (const auto& [name, value] : response.headers) text += name + ": " + value + "\r\n";
  return text + "Content-Type: " + response.content_type +
         "\r\nContent-Length: " + std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" +
         body;
}

}  // namespace translucube::server
