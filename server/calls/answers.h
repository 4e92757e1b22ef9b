#pragma once

// The answers that calls share.

#include <chrono>
#include <string>

#include "server/calls/calls.h"
#include "server/calls/parameters.h"
#include "server/http/negotiation.h"
#include "server/http/problems.h"

namespace translucube::server {

HttpResponse json_response(int status, std::string body);

/// A JSON answer that a client can ask for again at the price of a header.
HttpResponse tagged_json(const HttpRequest& request, const std::string& body);
HttpResponse tagged_json(const HttpRequest& request, const std::string& body,
                         const std::string& etag);

/// What `get` answers, at once or when `done` is true of its status or the time is over. Without a
/// place to wait, at once; `waited` then stays false.
template <typename Get, typename Done>
auto answer_after(CallContext& context, int seconds, bool& waited, Get get, Done done) {
  auto result = get();
  waited = false;
  if (seconds <= 0) return result;
  const Places::Place place = context.waiting.take();
  if (!place) return result;
  waited = true;
  context.service.changes().watch(std::chrono::seconds(seconds), [&] {
    result = get();
    return !result || done(*result);
  });
  return result;
}

/// What `get` answers, a Result<ToldText>. With `wait`: when it has ended, or is no longer as the
/// client's If-None-Match knows it.
template <typename Get>
HttpResponse status_response(CallContext& context, const HttpRequest& request, Get get) {
  const auto seconds = wait_query(request);
  if (!seconds) return problem_response(seconds.problem());
  const std::string_view known = request.header("if-none-match");
  bool waited = false;
  const auto status = answer_after(context, *seconds, waited, get, [&](const auto& now) {
    return api::is_end(now->state) || (!known.empty() && !etag_matches(known, now->etag));
  });
  if (!status) return problem_response(status.problem());
  const auto& [state, json, etag] = **status;
  return tagged_json(request, json, etag);
}

}  // namespace translucube::server
