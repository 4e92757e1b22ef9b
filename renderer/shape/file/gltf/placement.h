#pragma once

#include "renderer/base/vec.h"
#include "renderer/shape/file/gltf/value.h"

namespace translucube::gltf {

/// An affine map: the images of the axes and of the origin.
struct Placement {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;

  Vec3 vector(Vec3 v) const { return v.x * x + v.y * y + v.z * z; }
  Vec3 point(Vec3 p) const { return vector(p) + origin; }
  /// What is placed by `inner` and then by this.
  Placement of(const Placement& inner) const {
    return {vector(inner.x), vector(inner.y), vector(inner.z), point(inner.origin)};
  }
  /// Turns a body inside out.
  bool mirrors() const { return dot(x, cross(y, z)) < 0; }
};

/// How a node lies in its parent: by its matrix, or by scale, rotation and translation. Throws
/// MeshError.
Placement placement_of(const Value& node);

}  // namespace translucube::gltf
