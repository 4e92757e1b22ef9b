#include "renderer/light/environment_batch.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/light/environment_batch.cpp"
#include <hwy/foreach_target.h>
#include "renderer/base/simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// The angle of (x, y) from the x axis, in (-pi, pi].
HWY_INLINE Real atan2(Real y, Real x) {
  const Real ax = abs(x), ay = abs(y), tiny(1e-30f);
  const Real small = atan(min(ax, ay) / max(max(ax, ay), tiny));
  const Real quarter = select(ay > ax, Real(pi_f / 2) - small, small);
  const Real half = select(x < 0, Real(pi_f) - quarter, quarter);
  return copysign(half, y);
}

void Coordinates(const EnvironmentBatch& batch, const MapGeometry& map, EnvironmentBatch::Floats& u,
                 EnvironmentBatch::Floats& v, EnvironmentBatch::Floats& sin_theta) {
  for (std::size_t i = 0; i < batch.size; i += at_once) {
    const Vector d = load(batch.direction, i);
    const Real across = sqrt(fma(d.x, d.x, d.z * d.z));
    const Real turned = (atan2(d.x, d.z) - Real(map.rotation)) * Real(-0.5f / pi_f) + Real(0.5f);
    store((turned - floor(turned)) * Real(map.width), u, i);
    store(atan2(across, d.y) * Real(map.height / pi_f), v, i);
    store(across, sin_theta, i);
  }
}

void Directions(MapDirections& batch, const MapGeometry& map) {
  const Real turn(2 * pi_f / map.width), polar(pi_f / map.height);
  for (std::size_t i = 0; i < batch.size; i += at_once) {
    const Real azimuth = fnma(load(batch.u, i), turn, Real(pi_f + map.rotation));
    const Real theta = load(batch.v, i) * polar, across = sin(theta);
    store(Vector{across * sin(azimuth), cos(theta), across * cos(azimuth)}, batch.direction, i);
    store(across, batch.sin_theta, i);
  }
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(Coordinates);
HWY_EXPORT(Directions);

void MapDirections::find(const MapGeometry& map) { HWY_DYNAMIC_DISPATCH(Directions)(*this, map); }

void EnvironmentBatch::look_up(const ImageEnvironment& environment) {
  Floats u, v, sin_theta;
  HWY_DYNAMIC_DISPATCH(Coordinates)(*this, environment.geometry(), u, v, sin_theta);
  // The map does not fit the cache, and where the next ray looks is known.
  for (std::size_t i = 0; i < size; ++i) environment.prefetch(u[i], v[i]);
  for (std::size_t i = 0; i < size; ++i)
    value[i] = environment.value_at({u[i], v[i], sin_theta[i]});
  if (environment.side() == EnvironmentSide::all) return;
  const auto& height = environment.side() == EnvironmentSide::front ? direction.z : direction.y;
  for (std::size_t i = 0; i < size; ++i)
    if (height[i] < 0) value[i].radiance = {};
}

}  // namespace translucube
#endif
