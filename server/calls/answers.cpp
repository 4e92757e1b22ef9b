#include "server/calls/answers.h"

#include "server/base/ids.h"

namespace translucube::server {

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

HttpResponse removal_response(const std::optional<api::Problem>& problem) {
  return problem ? problem_response(*problem) : HttpResponse{204, {}, {}, {}};
}

}  // namespace translucube::server
