#pragma once

#include <string>
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

/// The canonical form: every default filled in, keys sorted, shortest round-trip numbers. Two
/// requests that mean the same have the same text. It parses back to the same request.
std::string canonical_json(const RenderRequest& request);

/// The same material in both forms and its derived optics, as JSON text: {"cube": ...,
/// "coefficients": ..., "mean_free_path_mm": ..., "albedo": ..., "color_through_reference":
/// [r,g,b]}.
std::string material_report(const RenderRequest& request, const Catalog& catalog);

/// Names to values: what the renderer needs. The request was validated against the same catalog.
SceneSpec scene_spec(const RenderRequest& request, const Catalog& catalog);

}  // namespace translucube::api
