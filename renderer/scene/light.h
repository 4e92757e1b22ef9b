#pragma once

#include "renderer/light/environment_cache.h"
#include "renderer/light/lighting.h"
#include "renderer/scene/spec.h"

namespace translucube {

/// The light of a scene for a body of this unit [mm], in its coordinates. Throws SceneError.
Lighting make_lighting(const SceneSpec& spec, Vec3 center_mm, double unit_mm,
                       EnvironmentCache& cache);

}  // namespace translucube
