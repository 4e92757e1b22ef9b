#pragma once

#include <optional>

#include "renderer/scene/scene.h"

namespace translucube {

/// An object in its own unit, and where it is.
struct PlacedShape {
  AnyShape shape;
  Vec3 center_mm;
  double unit_mm;
  double back;    ///< least z, in units
  double bottom;  ///< least y
  std::optional<Refinement> refinement = {};
  std::optional<MeshReport> mesh = {};
};

/// Reads or makes the object. Throws SceneError.
PlacedShape place_shape(const ObjectSpec& object);

}  // namespace translucube
