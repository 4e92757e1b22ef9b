#pragma once

// From names to values: what the renderer needs of a request, which was validated against the same
// catalog.

#include <span>

#include "api/request/catalog.h"
#include "api/request/request.h"
#include "renderer/scene/spec.h"

namespace translucube::api {

SceneSpec scene_spec(const RenderRequest& request, const Catalog& catalog);

/// The scene in which these requests are traced at once. They differ in their absorption only.
SceneSpec scene_spec(std::span<const RenderRequest> lanes, const Catalog& catalog);

}  // namespace translucube::api
