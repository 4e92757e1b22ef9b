#include "server/calls/handlers.h"
#include "server/http/negotiation.h"

namespace translucube::server {

using api::Problem;
using api::ProblemCode;
using api::Result;
using api::SweepStatus;

namespace {

Result<bool> dry_run_query(const HttpRequest& request) {
  for (const auto& [name, value] : request.query) {
    if (name != "dry_run" || value == "false") continue;
    if (value == "true") return true;
    return Problem{ProblemCode::invalid_request,
                   "A query parameter is not valid.",
                   {{"?dry_run", "must be true or false"}}};
  }
  return false;
}

}  // namespace

HttpResponse post_sweep(Endpoints& endpoints, const HttpRequest& request, const PathIds&) {
  const auto key = submission_key(request);
  if (!key) return problem_response(key.problem());
  const auto dry = dry_run_query(request);
  if (!dry) return problem_response(dry.problem());
  if (*dry) {
    auto counts = endpoints.service.count_sweep(request.body);
    if (!counts) return problem_response(counts.problem());
    return json_response(200, *std::move(counts));
  }
  const auto submitted = endpoints.service.submit_sweep(request.body, *key);
  if (!submitted) return problem_response(submitted.problem());
  const auto& [status, created] = *submitted;
  HttpResponse response = json_response(api::is_end(status.state) ? 200 : 202, to_json(status));
  response.headers = {{"Location", "/v1/sweeps/" + status.id}};
  if (!created) response.headers.emplace_back("Idempotency-Replayed", "true");
  return response;
}

HttpResponse list_sweeps(Endpoints& endpoints, const HttpRequest& request, const PathIds&) {
  const auto query = list_query(request);
  if (!query) return problem_response(query.problem());
  const auto page = endpoints.service.list_sweeps(*query);
  if (!page) return problem_response(page.problem());
  const auto& [sweeps, next_cursor] = *page;
  return tagged_json(request, api::sweep_list_json(sweeps, next_cursor));
}

HttpResponse get_sweep(Endpoints& endpoints, const HttpRequest& request, const PathIds& ids) {
  return status_response(endpoints, request, [&] { return endpoints.service.tell_sweep(ids.id); });
}

HttpResponse cancel_sweep(Endpoints& endpoints, const HttpRequest&, const PathIds& ids) {
  const auto status = endpoints.service.cancel_sweep(ids.id);
  if (!status) return problem_response(status.problem());
  return json_response(200, to_json(*status));
}

HttpResponse delete_sweep(Endpoints& endpoints, const HttpRequest&, const PathIds& ids) {
  if (const auto problem = endpoints.service.remove_sweep(ids.id))
    return problem_response(*problem);
  return {204, {}, {}, {}};
}

}  // namespace translucube::server
