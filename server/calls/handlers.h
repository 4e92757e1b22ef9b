#pragma once

// The handlers behind the routes of endpoints.cpp, and what they share.

#include <string>

#include "api/base/result.h"
#include "server/calls/router.h"
#include "server/http/negotiation.h"

namespace translucube::server {

/// What stands in a path in the places of "{id}", "{point}" and "{file}".
struct PathIds {
  std::string id, point, file;

  /// Where a segment of a pattern goes; nullptr where it stands for itself.
  std::string* place(std::string_view segment) {
    return segment == "{id}"      ? &id
           : segment == "{point}" ? &point
           : segment == "{file}"  ? &file
                                  : nullptr;
  }
};

// render_endpoints.cpp
HttpResponse post_render(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse list_renders(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse get_render(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse cancel_render(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse delete_render(Endpoints&, const HttpRequest&, const PathIds&);

// sweep_endpoints.cpp
HttpResponse post_sweep(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse list_sweeps(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse get_sweep(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse cancel_sweep(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse delete_sweep(Endpoints&, const HttpRequest&, const PathIds&);

// image_endpoint.cpp: negotiated, tagged, whole or in part.
HttpResponse get_image(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse get_point_image(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse get_sheet(Endpoints&, const HttpRequest&, const PathIds&);

// web_endpoint.cpp
HttpResponse get_page(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse get_web_file(Endpoints&, const HttpRequest&, const PathIds&);

// event_endpoint.cpp
HttpResponse get_render_events(Endpoints&, const HttpRequest&, const PathIds&);
HttpResponse get_sweep_events(Endpoints&, const HttpRequest&, const PathIds&);

HttpResponse json_response(int status, std::string body);
/// A JSON answer that a client can ask for again at the price of a header.
HttpResponse tagged_json(const HttpRequest& request, const std::string& body);
HttpResponse tagged_json(const HttpRequest& request, const std::string& body,
                         const std::string& etag);

/// A body that must be JSON, and an Idempotency-Key: a problem, or the key if there is one.
api::Result<std::optional<std::string>> submission_key(const HttpRequest& request);
/// The query of a list: cursor, limit, status.
api::Result<ListQuery> list_query(const HttpRequest& request);
/// Of `Prefer: wait` and `?wait=`.
inline constexpr int longest_wait_s = 60;
/// The query's `wait` [s], 0 where it is not there, longest_wait_s at most.
api::Result<int> wait_query(const HttpRequest& request);

/// One of a bounded number of places, given back at the end of its life.
class Place {
 public:
  Place(std::atomic<int>& taken, int most) : taken_(taken), got_(++taken_ <= most) {}
  ~Place() { --taken_; }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  bool got() const { return got_; }

 private:
  std::atomic<int>& taken_;
  bool got_;
};

/// What `get` answers, at once or when `done` is true of its status or the time is over. Without a
/// place to wait, at once; `waited` then stays false.
template <typename Get, typename Done>
auto answer_after(Endpoints& endpoints, int seconds, bool& waited, Get get, Done done) {
  auto result = get();
  waited = false;
  if (seconds <= 0) return result;
  const Place place(endpoints.waiting, endpoints.catalog.server.waiting_requests);
  if (!place.got()) return result;
  waited = true;
  endpoints.service.watch(std::chrono::seconds(seconds), [&] {
    result = get();
    return !result || done(*result);
  });
  return result;
}

/// What `get` answers, a Result<ToldText>. With `wait`: when it has ended, or is no longer as the
/// client's If-None-Match knows it.
template <typename Get>
HttpResponse status_response(Endpoints& endpoints, const HttpRequest& request, Get get) {
  const auto seconds = wait_query(request);
  if (!seconds) return problem_response(seconds.problem());
  const std::string_view known = request.header("if-none-match");
  bool waited = false;
  const auto status = answer_after(endpoints, *seconds, waited, get, [&](const auto& now) {
    return api::is_end(now->state) || (!known.empty() && !etag_matches(known, now->etag));
  });
  if (!status) return problem_response(status.problem());
  const auto& [state, json, etag] = **status;
  return tagged_json(request, json, etag);
}

}  // namespace translucube::server
