#pragma once

// The answers that calls share.

#include <chrono>
#include <string>
#include <utility>

#include "server/calls/calls.h"
#include "server/calls/parameters.h"
#include "server/http/negotiation.h"

namespace translucube::server {

HttpResponse json_response(int status, std::string body);

/// A JSON answer that a client can ask for again at the price of a header (preconditions.h).
HttpResponse tagged_json(std::string body);
HttpResponse tagged_json(std::string body, std::string etag);

/// 200 with a status as JSON, or its problem.
template <typename Status>
HttpResponse status_response(const api::Result<Status>& status) {
  if (!status) return problem_response(status.problem());
  return json_response(200, to_json(*status));
}

/// 204, or the problem why nothing was removed.
HttpResponse removal_response(const std::optional<api::Problem>& problem);

/// The page that `list` gives for the query, told by `json`.
template <typename List, typename Json>
HttpResponse list_response(const HttpRequest& request, List list, Json json) {
  const auto query = list_query(request);
  if (!query) return problem_response(query.problem());
  const auto page = list(*query);
  if (!page) return problem_response(page.problem());
  return tagged_json(json(*page));
}

/// What `get` answers, at once or when `done` is true of its status or the time is over. Without a
/// place to wait, at once; `waited` then stays false.
template <typename Get, typename Done>
auto answer_after(CallContext& context, const HttpRequest& request, int seconds, bool& waited,
                  Get get, Done done) {
  auto result = get();
  waited = !result || done(*result);
  if (waited || seconds <= 0) return result;
  const Places::Place place = context.waiting.take();
  if (!place) return result;
  waited = true;
  request.give_way();
  context.service.changes().watch(std::chrono::seconds(seconds), [&] {
    result = get();
    return !result || done(*result);
  });
  return result;
}

/// What `get` answers, a Result<ToldText>. With `wait`: when it has ended, or is no longer as the
/// client's If-None-Match knows it. While it waits it asks for the `moment`, which costs less.
template <typename Get, typename GetMoment>
HttpResponse awaited_status(CallContext& context, const HttpRequest& request, Get get,
                            GetMoment moment) {
  const auto seconds = wait_query(request);
  if (!seconds) return problem_response(seconds.problem());
  const std::string_view known = request.header("if-none-match");
  const auto is_news = [&](const api::Result<ToldText>& status) {
    return !status || (!known.empty() && !etag_matches(known, (*status)->etag));
  };
  auto status = get();
  bool waited = false;
  std::string seen;
  const auto ended_or_news = [&](const Moment& now) {
    if (api::is_end(now.state)) return true;
    if (known.empty() || std::exchange(seen, now.version) == now.version) return false;
    status = get();
    return is_news(status);
  };
  if (!is_news(status) && !api::is_end((*status)->state))
    static_cast<void>(answer_after(context, request, *seconds, waited, moment, ended_or_news));
  if (waited) status = get();
  if (!status) return problem_response(status.problem());
  const auto& [state, json, etag] = **status;
  return tagged_json(json, etag);
}

}  // namespace translucube::server
