#pragma once

// Slab optics as a document: what `translucube appearance` reads (api/answer/appearance_report.h
// has what it writes).

#include <string_view>

#include "api/base/result.h"
#include "api/request/catalog.h"
#include "api/request/request.h"

namespace translucube::api {

/// {"material": as in a render request, "slab": {"thickness_mm": 0.2},
///  "quality": {"standard_error": 1e-3} (of every total; the default), "seed": 1}
struct AppearanceRequest {
  MaterialRequest material;
  double thickness_mm = 0;       ///< [1e-6, 1e6]
  double standard_error = 1e-3;  ///< [1e-5, 1]
  std::uint64_t seed = 1;
};

/// All faults at once, or the request; as strict as parse_render_request.
Result<AppearanceRequest> parse_appearance_request(std::string_view text, const Catalog& catalog);

/// A render of the same material, all else as by default.
RenderRequest render_request(const AppearanceRequest& request, const Catalog& catalog);

}  // namespace translucube::api
