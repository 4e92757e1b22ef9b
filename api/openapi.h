#pragma once

#include <string_view>

namespace translucube::api {

/// The OpenAPI 3.1 document of the service (api/openapi.json, embedded by the build).
std::string_view openapi_document();

}  // namespace translucube::api
