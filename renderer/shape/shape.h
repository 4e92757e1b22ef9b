#pragma once

// Shapes: what rays meet. A shape enters the transport through a few questions only; it knows
// nothing of optics, of scenes or of paths. Lengths are in the body's own unit (sphere: its radius;
// mesh: its bounding radius), centred at the origin.

#include "renderer/base/vec.h"

namespace translucube {

struct Hit {
  Vec3 p;        ///< on the surface
  Vec3 n;        ///< outward unit normal
  double t = 0;  ///< distance travelled
};

// Every shape answers:
//   enter(p, d, hit)          first hit of a ray outside, towards the surface's front
//   exit(p, d, t_max, hit)    the hit of a ray inside if it is nearer than t_max
//   inside(p)                 whether a point lies in the body
//   clearance(p)              a lower bound of the distance of a point inside to the surface; for a
//   mesh, the
//                             walk's clearing.h keeps it
//   convex()                  whether a ray that leaves can never come back

}  // namespace translucube
