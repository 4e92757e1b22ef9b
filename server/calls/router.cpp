#include "server/calls/router.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "api/base/faults.h"
#include "server/base/ids.h"
#include "server/calls/preconditions.h"

namespace translucube::server {
namespace {

using api::ProblemCode;

using Parameters = std::array<std::string_view, 7>;

struct Route {
  std::string_view method, pattern;  ///< "{id}" and its like stand for a segment each
  HttpResponse (*handle)(CallContext&, const HttpRequest&, const PathParameters&);
  Parameters query{};  ///< those it knows
  std::optional<HttpResponse> (*receive)(CallContext&, HttpRequest&,
                                         const PathParameters&) = nullptr;
};

constexpr Parameters list_parameters{"cursor", "limit", "status"};
constexpr Parameters image_parameters{"format",     "display",  "view",   "colorspace",
                                      "absorption", "absorber", "partial"};
constexpr Parameters point_parameters{"format",     "display",    "view",
                                      "colorspace", "absorption", "absorber"};

constexpr std::array routes{
    Route{"POST", "/v1/renders", post_render},
    Route{"GET", "/v1/renders", list_renders, list_parameters},
    Route{"GET", "/v1/renders/{id}", get_render, {"wait"}},
    Route{"DELETE", "/v1/renders/{id}", delete_render},
    Route{"GET", "/v1/renders/{id}/image", get_image, image_parameters},
    Route{"GET", "/v1/renders/{id}/events", get_render_events},
    Route{"POST", "/v1/renders/{id}/cancel", cancel_render},
    Route{"POST", "/v1/sweeps", post_sweep, {"dry_run"}},
    Route{"GET", "/v1/sweeps", list_sweeps, list_parameters},
    Route{"GET", "/v1/sweeps/{id}", get_sweep, {"wait"}},
    Route{"DELETE", "/v1/sweeps/{id}", delete_sweep},
    Route{"GET", "/v1/sweeps/{id}/points/{point}/image", get_point_image, point_parameters},
    Route{"GET", "/v1/sweeps/{id}/sheet", get_sheet, {"format", "display", "view", "colorspace"}},
    Route{"GET", "/v1/sweeps/{id}/events", get_sweep_events},
    Route{"POST", "/v1/sweeps/{id}/cancel", cancel_sweep},
    Route{"GET", "/v1/absorbers", get_absorbers},
    Route{"GET", "/v1/environments", get_environments},
    Route{"PUT", "/v1/environments/{sha256}", put_environment, {}, receive_upload},
    Route{"GET", "/v1/meshes", get_meshes},
    Route{"PUT", "/v1/meshes/{sha256}", put_mesh, {}, receive_upload},
    Route{"GET", "/v1/objects", get_objects},
    Route{"GET", "/v1/displays", get_displays},
    Route{"GET", "/", get_page},
    Route{"GET", "/web/{file}", get_web_file},
    Route{"GET", "/livez", get_livez},
    Route{"GET", "/readyz", get_readyz},
    Route{"GET", "/openapi.json", get_openapi},
};

/// The first segment of a path without its leading slash, which is taken off it.
std::string_view take_segment(std::string_view& path) {
  const std::string_view segment = path.substr(0, path.find('/'));
  path.remove_prefix(std::min(path.size(), segment.size() + 1));
  return segment;
}

/// What stands in the places of the pattern, or nothing if it is another path.
std::optional<PathParameters> match(std::string_view pattern, std::string_view path) {
  PathParameters parameters;
  if (std::ranges::count(pattern, '/') != std::ranges::count(path, '/')) return std::nullopt;
  if (!path.starts_with('/')) return std::nullopt;
  pattern.remove_prefix(1);
  path.remove_prefix(1);
  while (!pattern.empty() || !path.empty()) {
    const std::string_view expected = take_segment(pattern), given = take_segment(path);
    std::string* place = parameters.place(expected);
    if (place != nullptr && !given.empty())
      *place = given;
    else if (expected != given)
      return std::nullopt;
  }
  return parameters;
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

/// What GET answers for the resource that a request changes: a render, not the act of cancelling
/// it.
HttpResponse current(CallContext& context, std::string_view path) {
  constexpr std::string_view act = "/cancel";
  if (path.ends_with(act)) path.remove_suffix(act.size());
  return respond(context, {"GET", std::string(path), {}, {}, {}});
}

HttpResponse carry_out(CallContext& context, const HttpRequest& request, const Route& route,
                       const PathParameters& parameters) {
  if (route.method == "GET")
    return conditional(request, route.handle(context, request, parameters));
  if (has_precondition(request))
    if (auto unmet = unmet_precondition(request, current(context, request.path)))
      return *std::move(unmet);
  return route.handle(context, request, parameters);
}

/// Where no route has the method. "*" is the service as a whole (RFC 9110, 9.3.7).
HttpResponse not_carried_out(std::string_view path, std::string_view method,
                             const std::string& allowed) {
  if (allowed.empty() && path != "*")
    return problem_response({ProblemCode::not_found, "There is nothing at this path.", {}});
  HttpResponse response =
      method == "OPTIONS"
          ? HttpResponse{204, {}, {}, {}}
          : problem_response({ProblemCode::method_not_allowed, "Allowed here: " + allowed, {}});
  response.headers.emplace_back("Allow", path == "*" ? "GET, HEAD, POST, PUT, DELETE" : allowed);
  return response;
}

}  // namespace

std::vector<Call> calls() {
  std::vector<Call> all;
  for (const Route& route : routes) {
    Call& call = all.emplace_back(Call{route.method, route.pattern, {}});
    std::ranges::copy_if(route.query, std::back_inserter(call.query),
                         [](std::string_view name) { return !name.empty(); });
  }
  return all;
}

std::string_view route_pattern(std::string_view path) {
  const auto route = std::ranges::find_if(
      routes, [&](const Route& known) { return match(known.pattern, path).has_value(); });
  return route == routes.end() ? "" : route->pattern;
}

std::optional<HttpResponse> receive(CallContext& context, HttpRequest& request) {
  for (const Route& route : routes)
    if (route.receive != nullptr && route.method == request.method)
      if (const auto parameters = match(route.pattern, request.path))
        return route.receive(context, request, *parameters);
  return std::nullopt;
}

HttpResponse respond(CallContext& context, const HttpRequest& request) {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  std::string allowed;
  for (const Route& route : routes) {
    const std::optional<PathParameters> parameters = match(route.pattern, request.path);
    if (!parameters) continue;
    if (route.method != method) {
      allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
      if (route.method == "GET") allowed += ", HEAD";
      continue;
    }
    std::vector<api::Fault> faults = query_faults(route, request);
    if (!faults.empty()) return problem_response(api::invalid_query(std::move(faults)));
    if (!parameters->id.empty() && !is_id(parameters->id))
      return problem_response({ProblemCode::not_found, "There is nothing of this id.", {}});
    return carry_out(context, request, route, *parameters);
  }
  return not_carried_out(request.path, method, allowed);
}

}  // namespace translucube::server
