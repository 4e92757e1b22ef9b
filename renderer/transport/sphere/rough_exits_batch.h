#pragma once

// Next-event estimation through the rough boundary of the unit sphere, many vertices at a time, in
// SIMD and single precision. To reach a light, a direction is drawn in which a microfacet, at about
// the place where the smooth surface would refract towards the light, sends the light in: by
// reciprocity about the shape of what the surface sends out.

#include "renderer/transport/sphere/vertex_batch.h"

namespace translucube {

/// What is the same for all vertices of a body.
struct RoughExitMedium {
  float ior = 1.5f, alpha = 0.1f;
  float sigma_s = 0;  ///< [1 / radius]
  float g = 0;
};

/// Connections, by one collision with a microfacet on the way out.
struct RoughConnections : VertexBatch {
  Floats light_pdf{};  ///< in: of the light, per solid angle
  Streams random{};    ///< in
  /// Out: share of the vertex's light that leaves towards the light, over the light's density and
  /// weighted by the balance heuristic against the walk's own way there; the length inside.
  Floats share, distance;
  Vectors normal;  ///< where it leaves
};
void connect_rough(const RoughExitMedium& medium, RoughConnections& connections);

/// Walks that left the vertex along d and, by one collision, the surface towards the light: the
/// density per solid angle with which connect_rough() would have drawn d for that light.
struct RoughWays : VertexBatch {
  Floats density;
};
void densities_of(const RoughExitMedium& medium, RoughWays& ways);

}  // namespace translucube
