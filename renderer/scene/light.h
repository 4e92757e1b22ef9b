#pragma once

#include "renderer/light/environment_cache.h"
#include "renderer/light/lighting.h"
#include "renderer/scene/spec.h"

namespace translucube {

/// The light of a scene for a body of this unit [mm], in its coordinates. Throws SceneError.
Lighting make_lighting(const SceneSpec& spec, Vec3 center_mm, double unit_mm,
                       EnvironmentCache& cache);

/// The least height along n (unit) [mm] of a lamp near by; of a sun, infinity.
double lowest_mm(const LightSpec& light, Vec3 n);

}  // namespace translucube
