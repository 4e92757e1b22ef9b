#pragma once

// If-Match and If-None-Match (RFC 9110, 13). Nothing here has a time of its last change, so that
// the preconditions on times do not apply.

#include <optional>
#include <string_view>

#include "server/http/message.h"

namespace translucube::server {

bool has_precondition(const HttpRequest& request);

/// The answer to GET or HEAD as its preconditions want it: 304 without content where the client has
/// it, 412 where it wants another.
HttpResponse conditional(const HttpRequest& request, HttpResponse answer);

/// 412 where a request that changes something must not be carried out. `current`: what GET of the
/// same resource answers.
std::optional<HttpResponse> unmet_precondition(const HttpRequest& request,
                                               const HttpResponse& current);

}  // namespace translucube::server
