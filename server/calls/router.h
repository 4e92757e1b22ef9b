#pragma once

// From a path and a method to the call that answers.

#include <string_view>
#include <vector>

#include "server/calls/calls.h"

namespace translucube::server {

/// The answer to any request; a failure of ours that is not foreseen passes as an exception.
HttpResponse respond(CallContext& context, const HttpRequest& request);

/// What is done once the headers of a request are known: a body that is not for memory gets its
/// file, or is refused.
std::optional<HttpResponse> receive(CallContext& context, HttpRequest& request);

/// The pattern of the route that a path takes (/v1/renders/{id}/image), "" if it is none.
std::string_view route_pattern(std::string_view path);

struct Call {
  std::string_view method, pattern;     ///< "GET", "/v1/renders/{id}"
  std::vector<std::string_view> query;  ///< the parameters it knows
};
/// Every call that `respond` knows.
std::vector<Call> calls();

}  // namespace translucube::server
