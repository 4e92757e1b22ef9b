#pragma once

#include <string>

#include "api/request/catalog.h"
#include "api/request/request.h"

namespace translucube::api {

/// The request's material in the cube and as coefficients, and its derived optics, as JSON text:
/// {"cube": ..., "coefficients": ..., "mean_free_path_mm": ..., "albedo": ...,
/// "color_through_reference": [r,g,b]}.
std::string material_report(const RenderRequest& request, const Catalog& catalog);

}  // namespace translucube::api
