#pragma once

// Next-event estimation through the rough boundary of the unit sphere, many vertices at a time, in
// SIMD and single precision. To reach a light, a direction is drawn in which a microfacet, at about
// the place where the smooth surface would refract towards the light, sends the light in: by
// reciprocity about the shape of what the surface sends out.

#include <array>
#include <cstddef>
#include <cstdint>

namespace translucube {

/// What is the same for all vertices of a body.
struct RoughExitMedium {
  float ior = 1.5f, alpha = 0.1f;
  float sigma_s = 0;  ///< [1 / radius]
  float g = 0;
};

/// Scattering vertices, each with a direction towards a light (structure of arrays).
struct RoughExitBatch {
  static constexpr std::size_t capacity = 256;  ///< a multiple of every register's lanes
  /// So that equal places of two arrays do not fall into the same set of a cache.
  static constexpr std::size_t padding = 16;
  using Floats = std::array<float, capacity + padding>;

  std::size_t size = 0;
  // Where from: outward radius (unit), 1 - rho^2. Where to: the light (unit).
  Floats up_x{}, up_y{}, up_z{}, depth2{}, light_x{}, light_y{}, light_z{};
  // A direction inside (unit): of travel before the vertex, or from it.
  Floats d_x{}, d_y{}, d_z{};
};

/// Connections, by one collision with a microfacet on the way out.
struct RoughConnections : RoughExitBatch {
  Floats light_pdf{};                                         ///< in: of the light, per solid angle
  std::array<std::uint32_t, capacity> key_low{}, key_high{};  ///< in: of its random numbers
  /// Out: share of the vertex's light that leaves towards the light, over the light's density and
  /// weighted by the balance heuristic against the walk's own way there; the length inside.
  Floats share, distance;
};
void connect_rough(const RoughExitMedium& medium, RoughConnections& connections);

/// Walks that left the vertex along d and, by one collision, the surface towards the light: the
/// density per solid angle with which connect_rough() would have drawn d for that light.
struct RoughWays : RoughExitBatch {
  Floats density;
};
void densities_of(const RoughExitMedium& medium, RoughWays& ways);

}  // namespace translucube
