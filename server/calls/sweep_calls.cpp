#include "server/calls/handlers.h"
#include "server/http/negotiation.h"

namespace translucube::server {

using api::Problem;
using api::ProblemCode;
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
  if (const auto* problem = std::get_if<Problem>(&key)) return problem_response(*problem);
  const auto dry = dry_run_query(request);
  if (const auto* problem = std::get_if<Problem>(&dry)) return problem_response(*problem);
  if (std::get<bool>(dry)) {
    auto counts = endpoints.service.count_sweep(request.body);
    if (const auto* problem = std::get_if<Problem>(&counts)) return problem_response(*problem);
    return json_response(200, std::get<std::string>(std::move(counts)));
  }
  const auto submitted =
      endpoints.service.submit_sweep(request.body, std::get<std::optional<std::string>>(key));
  if (const auto* problem = std::get_if<Problem>(&submitted)) return problem_response(*problem);
  const auto& [status, created] = std::get<SweepSubmission>(submitted);
  HttpResponse response = json_response(api::is_end(status.state) ? 200 : 202, to_json(status));
  response.headers = {{"Location", "/v1/sweeps/" + status.id}};
  if (!created) response.headers.emplace_back("Idempotency-Replayed", "true");
  return response;
}

HttpResponse list_sweeps(Endpoints& endpoints, const HttpRequest& request, const PathIds&) {
  const auto query = list_query(request);
  if (const auto* problem = std::get_if<Problem>(&query)) return problem_response(*problem);
  const auto page = endpoints.service.list_sweeps(std::get<ListQuery>(query));
  if (const auto* problem = std::get_if<Problem>(&page)) return problem_response(*problem);
  const auto& [sweeps, next_cursor] = std::get<SweepPage>(page);
  return tagged_json(request, api::sweep_list_json(sweeps, next_cursor));
}

HttpResponse get_sweep(Endpoints& endpoints, const HttpRequest& request, const PathIds& ids) {
  return status_response(endpoints, request, [&] { return endpoints.service.tell_sweep(ids.id); });
}

HttpResponse cancel_sweep(Endpoints& endpoints, const HttpRequest&, const PathIds& ids) {
  const auto status = endpoints.service.cancel_sweep(ids.id);
  if (const auto* problem = std::get_if<Problem>(&status)) return problem_response(*problem);
  return json_response(200, to_json(std::get<SweepStatus>(status)));
}

HttpResponse delete_sweep(Endpoints& endpoints, const HttpRequest&, const PathIds& ids) {
  if (const auto problem = endpoints.service.remove_sweep(ids.id))
    return problem_response(*problem);
  return {204, {}, {}, {}};
}

}  // namespace translucube::server
