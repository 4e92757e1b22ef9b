#include "server/endpoints.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <span>

#include "api/listings.h"
#include "api/openapi.h"
#include "server/http_negotiation.h"
#include "server/image_endpoint.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;

constexpr int longest_wait_s = 60;
constexpr int default_page = 50, longest_page = 200;

HttpResponse json_response(int status, std::string body) {
  return {status, {}, "application/json", std::move(body)};
}

/// A JSON answer that a client can ask for again at the price of a header.
HttpResponse tagged_json(const HttpRequest& request, std::string body) {
  const std::string etag = '"' + content_hash(body) + '"';
  HttpResponse response = json_response(200, std::move(body));
  if (etag_matches(request.header("if-none-match"), etag)) response = {304, {}, {}, {}};
  response.headers = {{"ETag", etag}, {"Cache-Control", "no-cache"}};
  return response;
}

/// Waits on behalf of a client, if there is a place to wait.
class WaitingPlace {
 public:
  explicit WaitingPlace(Endpoints& endpoints)
      : waiting_(endpoints.waiting), taken_(++waiting_ <= endpoints.max_waiting) {}
  ~WaitingPlace() { --waiting_; }
  WaitingPlace(const WaitingPlace&) = delete;
  WaitingPlace& operator=(const WaitingPlace&) = delete;
  bool taken() const { return taken_; }

 private:
  std::atomic<int>& waiting_;
  bool taken_;
};

HttpResponse post_render(Endpoints& endpoints, const HttpRequest& request, const std::string&) {
  const std::string_view type = request.header("content-type");
  if (!type.empty() && !is_json(type))
    return problem_response({ProblemCode::unsupported_media_type,
                             "The body must be sent as Content-Type: application/json.",
                             {}});
  std::optional<std::string> key;
  if (const auto it = request.headers.find("idempotency-key"); it != request.headers.end()) {
    key = it->second;
    if (!is_idempotency_key(*key))
      return problem_response({ProblemCode::invalid_request,
                               "The Idempotency-Key must be 1 to 255 visible ASCII characters.",
                               {}});
  }

  auto submitted = endpoints.service.submit(request.body, key);
  if (const auto* problem = std::get_if<Problem>(&submitted)) return problem_response(*problem);
  auto& [status, created] = std::get<Submission>(submitted);

  std::string applied;
  if (const std::optional<int> asked = preferred_wait(request.header("prefer"))) {
    const int seconds = std::min(*asked, longest_wait_s);
    const WaitingPlace place(endpoints);
    if (place.taken()) {
      auto waited = endpoints.service.wait(status.id, std::chrono::seconds(seconds));
      if (const auto* problem = std::get_if<Problem>(&waited)) return problem_response(*problem);
      status = std::get<api::RenderStatus>(std::move(waited));
      applied = "wait=" + std::to_string(seconds);
    }
  }
  HttpResponse response = json_response(api::is_end(status.state) ? 200 : 202, to_json(status));
  response.headers = {{"Location", "/v1/renders/" + status.id}};
  if (!applied.empty()) response.headers.emplace_back("Preference-Applied", applied);
  if (!created) response.headers.emplace_back("Idempotency-Replayed", "true");
  return response;
}

HttpResponse list_renders(Endpoints& endpoints, const HttpRequest& request, const std::string&) {
  ListQuery query{std::nullopt, std::nullopt, default_page};
  Problem problem{ProblemCode::invalid_request, "A query parameter is not valid.", {}};
  for (const auto& [name, value] : request.query) {
    if (name == "cursor") query.cursor = value;
    if (name == "status") {
      query.state = api::job_state(value);
      if (!query.state)
        problem.faults.push_back(
            {"?status", "must be one of queued, running, succeeded, failed, canceled"});
    }
    if (name == "limit") {
      const char* end = value.data() + value.size();
      const auto [at, error] = std::from_chars(value.data(), end, query.limit);
      if (error != std::errc() || at != end || query.limit < 1 || query.limit > longest_page)
        problem.faults.push_back({"?limit", "must be an integer from 1 to 200"});
    }
  }
  if (!problem.faults.empty()) return problem_response(problem);
  const auto page = endpoints.service.list(query);
  if (const auto* failed = std::get_if<Problem>(&page)) return problem_response(*failed);
  const auto& [renders, next_cursor] = std::get<RenderPage>(page);
  return tagged_json(request, api::render_list_json(renders, next_cursor));
}

HttpResponse get_render(Endpoints& endpoints, const HttpRequest& request, const std::string& id) {
  const auto status = endpoints.service.get(id);
  if (const auto* problem = std::get_if<Problem>(&status)) return problem_response(*problem);
  return tagged_json(request, to_json(std::get<api::RenderStatus>(status)));
}

HttpResponse cancel_render(Endpoints& endpoints, const HttpRequest&, const std::string& id) {
  const auto status = endpoints.service.cancel(id);
  if (const auto* problem = std::get_if<Problem>(&status)) return problem_response(*problem);
  return json_response(200, to_json(std::get<api::RenderStatus>(status)));
}

HttpResponse delete_render(Endpoints& endpoints, const HttpRequest&, const std::string& id) {
  if (const auto problem = endpoints.service.remove(id)) return problem_response(*problem);
  return {204, {}, {}, {}};
}

HttpResponse get_image(Endpoints& endpoints, const HttpRequest& request, const std::string& id) {
  return image_response(endpoints.service, request, id);
}

HttpResponse get_absorbers(Endpoints& endpoints, const HttpRequest& request, const std::string&) {
  return tagged_json(request, api::absorbers_json(endpoints.catalog));
}

HttpResponse get_environments(Endpoints& endpoints, const HttpRequest& request,
                              const std::string&) {
  return tagged_json(request, api::environments_json(endpoints.catalog));
}

HttpResponse get_displays(Endpoints& endpoints, const HttpRequest& request, const std::string&) {
  return tagged_json(request, api::displays_json(endpoints.colors.displays()));
}

HttpResponse get_openapi(Endpoints&, const HttpRequest& request, const std::string&) {
  return tagged_json(request, std::string(api::openapi_document()));
}

HttpResponse livez(Endpoints&, const HttpRequest&, const std::string&) {
  return json_response(200, R"({"status":"alive"})");
}

HttpResponse readyz(Endpoints& endpoints, const HttpRequest&, const std::string&) {
  if (const auto reason = endpoints.service.unready_reason())
    return problem_response({ProblemCode::overloaded, *reason, {}});
  return json_response(200, R"({"status":"ready"})");
}

struct Route {
  std::string_view method, pattern;  ///< "{id}" stands for one segment
  HttpResponse (*handle)(Endpoints&, const HttpRequest&, const std::string& id);
  std::array<std::string_view, 6> query{};  ///< the parameters it knows
};

constexpr std::array routes{
    Route{"POST", "/v1/renders", post_render},
    Route{"GET", "/v1/renders", list_renders, {"cursor", "limit", "status"}},
    Route{"GET", "/v1/renders/{id}", get_render},
    Route{"DELETE", "/v1/renders/{id}", delete_render},
    Route{"GET",
          "/v1/renders/{id}/image",
          get_image,
          {"format", "display", "view", "colorspace", "absorption", "absorber"}},
    Route{"POST", "/v1/renders/{id}/cancel", cancel_render},
    Route{"GET", "/v1/absorbers", get_absorbers},
    Route{"GET", "/v1/environments", get_environments},
    Route{"GET", "/v1/displays", get_displays},
    Route{"GET", "/livez", livez},
    Route{"GET", "/readyz", readyz},
    Route{"GET", "/openapi.json", get_openapi},
};

/// The segment in the place of "{id}" ("" where there is none), or nothing if it is another path.
std::optional<std::string> match(std::string_view pattern, std::string_view path) {
  const std::size_t brace = pattern.find("{id}");
  if (brace == pattern.npos) return pattern == path ? std::optional("") : std::nullopt;
  const std::string_view before = pattern.substr(0, brace), after = pattern.substr(brace + 4);
  if (path.size() <= before.size() + after.size() || !path.starts_with(before) ||
      !path.ends_with(after))
    return std::nullopt;
  const std::string_view id =
      path.substr(before.size(), path.size() - before.size() - after.size());
  if (id.find('/') != id.npos) return std::nullopt;
  return std::string(id);
}

std::vector<api::Fault> query_faults(const Route& route, const HttpRequest& request) {
  std::vector<api::Fault> faults;
  for (auto it = request.query.begin(); it != request.query.end(); ++it) {
    const std::string& name = it->first;
    if (name.empty() || std::ranges::find(route.query, name) == route.query.end())
      faults.push_back({"?" + name, "unknown query parameter"});
    else if (std::any_of(request.query.begin(), it,
                         [&](auto& other) { return other.first == name; }))
      faults.push_back({"?" + name, "given more than once"});
  }
  return faults;
}

}  // namespace

HttpResponse respond(Endpoints& endpoints, const HttpRequest& request) {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  std::string allowed;
  for (const Route& route : routes) {
    const std::optional<std::string> id = match(route.pattern, request.path);
    if (!id) continue;
    if (route.method != method) {
      allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
      if (route.method == "GET") allowed += ", HEAD";
      continue;
    }
    const std::vector<api::Fault> faults = query_faults(route, request);
    if (!faults.empty())
      return problem_response(
          {ProblemCode::invalid_request, "A query parameter is not valid.", faults});
    if (!id->empty() && !is_id(*id))
      return problem_response({ProblemCode::not_found, "There is no render of this id.", {}});
    return route.handle(endpoints, request, *id);
  }
  if (allowed.empty())
    return problem_response({ProblemCode::not_found, "There is nothing at this path.", {}});
  HttpResponse response =
      method == "OPTIONS"
          ? HttpResponse{204, {}, {}, {}}
          : problem_response({ProblemCode::method_not_allowed, "Allowed here: " + allowed, {}});
  response.headers.emplace_back("Allow", allowed);
  return response;
}

}  // namespace translucube::server
