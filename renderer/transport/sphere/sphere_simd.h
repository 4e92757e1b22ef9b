// Points inside the unit sphere and the ways from there to its surface, in as many elements as a
// register has (see simd.h for how this is included).

#include "renderer/base/simd.h"
#include "renderer/transport/sphere/vertex_batch.h"

#if defined(TRANSLUCUBE_SPHERE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TRANSLUCUBE_SPHERE_SIMD_H
#undef TRANSLUCUBE_SPHERE_SIMD_H
#else
#define TRANSLUCUBE_SPHERE_SIMD_H
#endif

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// Length of the way along d (unit) from a point p to the surface, as in sphere.h, without
/// cancellation on either side: b = dot(p, d), depth2 = 1 - |p|^2.
HWY_INLINE Real way_to_surface(Real b, Real depth2) {
  const Real root = sqrt(fma(b, b, depth2));
  return select(b > 0, depth2 / (b + root), root - b);
}

/// A vertex of a batch.
struct Vertex {
  Vector up;    ///< outward radius, unit
  Real depth2;  ///< 1 - rho^2
  Real rho = sqrt(Real(1) - depth2);

  template <class Place>
  HWY_INLINE Vertex(const VertexBatch& batch, Place at)
      : up(load(batch.up, at)), depth2(load(batch.depth2, at)) {}

  HWY_INLINE Real way_along(Vector d) const { return way_to_surface(rho * dot(up, d), depth2); }
  /// The point at this distance along d.
  HWY_INLINE Vector at(Real distance, Vector d) const { return fma(distance, d, rho * up); }
};

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
