#pragma once

#include <string_view>

#include "api/base/result.h"
#include "api/request/catalog.h"
#include "api/request/request.h"

namespace translucube::api {

/// Parses and validates a render request against the catalog (defaults, names, folders, limits):
/// all faults at once, or the request. Strict: unknown or duplicate keys, wrong types, fractions
/// for integers, non-finite numbers, invalid UTF-8, nesting deeper than 16 and more than
/// catalog.limits.body_bytes bytes are refused; nothing is clamped.
/// Resources are checked too: names exist, files lie in allowed folders, meshes are closed.
Result<RenderRequest> parse_render_request(std::string_view text, const Catalog& catalog);

}  // namespace translucube::api
