#pragma once

// Bodies of our own: each a closed mesh of few triangles with the normals of the surface that they
// stand for (shape/smooth), made from a few numbers. Lengths are the caller's.

#include <cstdint>

#include "renderer/shape/smooth/refine.h"
#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// Coarse; refined() is what rays meet.
struct BodyMesh {
  TriangleMesh mesh;
  double thinnest = 0;        ///< what light must tell from the rest of the body
  Fineness wish{2e-5, 1e-3};  ///< that no picture shows
};

/// As fine as no picture shows, of at most a million triangles.
TriangleMesh refined(BodyMesh body);

/// A ring about y: `major` from the axis to the middle of the tube, `minor` its radius.
BodyMesh make_torus(double major, double minor);

/// The box of these extents with its edges rounded to a radius of at most half of each.
BodyMesh make_rounded_box(Vec3 extents, double edge);

/// A plate within these extents whose front (+z) has ridges along y, as high as `share` of its
/// depth. Across them it rises and falls by a raised cosine that takes all the way from middle to
/// middle at `sharpness` 0, and none of it at 1: upright walls.
BodyMesh make_relief(Vec3 extents, double sharpness, double share, std::uint32_t ridges);

/// A sphere with smooth random bumps of the size `scale`, both in units of its radius: a random sum
/// of plane waves that is squashed to `bump` times +-0.45.
BodyMesh make_blob(double radius, double bump, double scale, std::uint64_t seed);

/// A dragon that stands along x, of this length, and looks towards -x.
BodyMesh make_dragon(double length);

}  // namespace translucube
