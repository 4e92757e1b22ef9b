#pragma once

#include <string>

#include "api/request/request.h"

namespace translucube::api {

/// The canonical form: every default filled in, keys sorted, shortest round-trip numbers. Two
/// requests that mean the same have the same text. It parses back to the same request.
std::string canonical_json(const RenderRequest& request);

}  // namespace translucube::api
