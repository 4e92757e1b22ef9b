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
  return list_response(
      request, [&](const ListQuery& query) { return context.service.list_sweeps(query); },
      [](const SweepPage& page) { return api::sweep_list_json(page.sweeps, page.next_cursor); });
}

HttpResponse get_sweep(CallContext& context, const HttpRequest& request,
                       const PathParameters& path) {
  return awaited_status(
      context, request, [&] { return context.service.tell_sweep(path.id); },
      [&] { return context.service.moment_of_sweep(path.id); });
}

HttpResponse cancel_sweep(CallContext& context, const HttpRequest&, const PathParameters& path) {
  return status_response(context.service.cancel_sweep(path.id));
}

HttpResponse delete_sweep(CallContext& context, const HttpRequest&, const PathParameters& path) {
  return removal_response(context.service.remove_sweep(path.id));
}

}  // namespace translucube::server
