#include "server/calls/answers.h"

#include "server/base/ids.h"

namespace translucube::server {

HttpResponse json_response(int status, std::string body) {
  return {status, {}, "application/json", std::move(body)};
}

HttpResponse tagged_json(std::string body) {
  std::string etag = '"' + content_hash(body) + '"';
  return tagged_json(std::move(body), std::move(etag));
}

HttpResponse tagged_json(std::string body, std::string etag) {
  HttpResponse response = json_response(200, std::move(body));
  response.headers = {{"ETag", std::move(etag)}, {"Cache-Control", "no-cache"}};
  return response;
}

HttpResponse removal_response(const std::optional<api::Problem>& problem) {
  return problem ? problem_response(*problem) : HttpResponse{204, {}, {}, {}};
}

}  // namespace translucube::server
