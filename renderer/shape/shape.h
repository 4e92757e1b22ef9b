#pragma once

// Shapes: what rays meet. The transport asks a shape a few questions only; a shape knows
// nothing of optics, of scenes or of paths. Lengths are in the body's own unit (sphere: its radius;
// mesh: its bounding radius), centred at the origin.

#include <cstdint>

#include "renderer/base/vec.h"

namespace translucube {

struct Hit {
  Vec3 p;                  ///< on the surface
  Vec3 n;                  ///< outward unit normal
  double t = 0;            ///< distance travelled
  std::uint32_t face = 0;  ///< of a body with flat faces
};

// Every shape answers:
//   intersect_outside(p, d, hit)        the first hit of a ray outside, on the surface's front
//   intersect_inside(p, d, t_max, hit)  the hit of a ray inside, if it is nearer than t_max
//   inside(p)                           whether a point lies in the body
//   clearance(p)                        a lower bound of the distance of a point inside to the
//                                       surface; in a mesh, clearing.h of a walk keeps it
//   convex()                            whether a ray that leaves can never come back

}  // namespace translucube
