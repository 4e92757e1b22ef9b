#include <algorithm>

#include "server/calls/answers.h"

namespace translucube::server {

using api::RenderStatus;

namespace {

bool has_ended(const RenderStatus& status) { return api::is_end(status.state); }

}  // namespace

HttpResponse post_render(CallContext& context, const HttpRequest& request, const PathParameters&) {
  const auto key = submission_key(request);
  if (!key) return problem_response(key.problem());
  auto submitted = context.service.submit(request.body, *key);
  if (!submitted) return problem_response(submitted.problem());
  auto& [status, created] = *submitted;

  std::string applied;
  if (const std::optional<int> asked = preferred_wait(request.header("prefer"))) {
    const int seconds = std::min(*asked, longest_wait_s);
    bool waited = false;
    auto result = answer_after(
        context, request, seconds, waited, [&] { return context.service.get(status.id); },
        has_ended);
    if (!result) return problem_response(result.problem());
    status = *std::move(result);
    if (waited || seconds == 0) applied = "wait=" + std::to_string(seconds);
  }
  HttpResponse response = json_response(has_ended(status) ? 200 : 202, to_json(status));
  response.headers = {{"Location", "/v1/renders/" + status.id}};
  if (!applied.empty()) response.headers.emplace_back("Preference-Applied", applied);
  if (!created) response.headers.emplace_back("Idempotency-Replayed", "true");
  return response;
}

HttpResponse list_renders(CallContext& context, const HttpRequest& request, const PathParameters&) {
  return list_response(
      request, [&](const ListQuery& query) { return context.service.list(query); },
      [](const RenderPage& page) { return api::render_list_json(page.renders, page.next_cursor); });
}

HttpResponse get_render(CallContext& context, const HttpRequest& request,
                        const PathParameters& path) {
  return awaited_status(
      context, request, [&] { return context.service.tell(path.id); },
      [&] { return context.service.moment(path.id); });
}

HttpResponse cancel_render(CallContext& context, const HttpRequest&, const PathParameters& path) {
  return status_response(context.service.cancel(path.id));
}

HttpResponse delete_render(CallContext& context, const HttpRequest&, const PathParameters& path) {
  return removal_response(context.service.remove(path.id));
}

}  // namespace translucube::server
