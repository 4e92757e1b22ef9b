#include "server/calls/answers.h"

namespace translucube::server {

HttpResponse post_sweep(CallContext& context, const HttpRequest& request, const PathParameters&) {
  const auto key = submission_key(request);
  if (!key) return problem_response(key.problem());
  const auto dry = flag_query(request, "dry_run");
  if (!dry) return problem_response(dry.problem());
  if (*dry) {
    auto counts = context.service.count_sweep(request.body);
    if (!counts) return problem_response(counts.problem());
    return json_response(200, *std::move(counts));
  }
  const auto submitted = context.service.submit_sweep(request.body, *key);
  if (!submitted) return problem_response(submitted.problem());
  const auto& [status, created] = *submitted;
  HttpResponse response = json_response(api::is_end(status.state) ? 200 : 202, to_json(status));
  response.headers = {{"Location", "/v1/sweeps/" + status.id}};
  if (!created) response.headers.emplace_back("Idempotency-Replayed", "true");
  return response;
}

HttpResponse list_sweeps(CallContext& context, const HttpRequest& request, const PathParameters&) {
  const auto query = list_query(request);
  if (!query) return problem_response(query.problem());
  const auto page = context.service.list_sweeps(*query);
  if (!page) return problem_response(page.problem());
  const auto& [sweeps, next_cursor] = *page;
  return tagged_json(request, api::sweep_list_json(sweeps, next_cursor));
}

HttpResponse get_sweep(CallContext& context, const HttpRequest& request,
                       const PathParameters& path) {
  return status_response(context, request, [&] { return context.service.tell_sweep(path.id); });
}

HttpResponse cancel_sweep(CallContext& context, const HttpRequest&, const PathParameters& path) {
  const auto status = context.service.cancel_sweep(path.id);
  if (!status) return problem_response(status.problem());
  return json_response(200, to_json(*status));
}

HttpResponse delete_sweep(CallContext& context, const HttpRequest&, const PathParameters& path) {
  if (const auto problem = context.service.remove_sweep(path.id)) return problem_response(*problem);
  return {204, {}, {}, {}};
}

}  // namespace translucube::server
