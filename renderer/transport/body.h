#pragma once

#include <type_traits>

#include "renderer/optics/interior.h"
#include "renderer/transport/boundary/facet_connector.h"
#include "renderer/transport/boundary/microfacet_connector.h"
#include "renderer/transport/sphere/rough_connector.h"
#include "renderer/transport/sphere/smooth_connector.h"

namespace translucube {

/// One alternative of each part of a scene's body, and what follows from the three.
template <class ShapeType, class InterfaceType, class InteriorType>
struct Body {
  using Shape = ShapeType;
  using Interface = InterfaceType;
  using Interior = InteriorType;
  const Shape& shape;
  const Interface& interface;
  const Interior& interior;

  static constexpr InteriorFacts inside = Interior::facts;
  static constexpr bool smooth = Interface::smooth;
  /// Paths go on below the interface, and come to it from inside.
  static constexpr bool lets_in = inside.open || inside.half_space;
  /// Walks go on together, in SIMD: what a sphere's boundary is simple enough for.
  static constexpr bool walks_together = inside.scatters && std::is_same_v<Shape, Sphere>;
  /// Trapped light rolls from reflection to reflection in one step.
  static constexpr bool rolls = inside.scatters && std::is_same_v<Shape, Sphere>;
  /// Scattering vertices connect to lights through the boundary.
  static constexpr bool flat = std::is_same_v<Shape, Mesh> || std::is_same_v<Shape, Polytope>;
  static constexpr bool connects = inside.scatters && (walks_together || flat || !smooth);
  static constexpr bool connects_alone = connects && !walks_together;
  using SphereConnector = std::conditional_t<smooth, SmoothConnector, RoughConnector>;
  using BoundaryConnector =
      std::conditional_t<smooth, FacetConnector<Shape>, MicrofacetConnector<Shape>>;
  using Connector =
      std::conditional_t<!connects, NoConnector,
                         std::conditional_t<walks_together, SphereConnector, BoundaryConnector>>;
};

}  // namespace translucube
