#pragma once

// Next-event estimation through the smooth boundary of the unit sphere, many vertices at a time:
// the ways out of smooth_exits.h in SIMD and single precision.

#include "renderer/optics/medium.h"
#include "renderer/transport/sphere/smooth_exits.h"
#include "renderer/transport/sphere/vertex_batch.h"

namespace translucube {

/// What is the same for all vertices of a body.
struct SmoothExitMedium {
  float ior = 1.5f;   ///< >= 1
  float sigma_s = 0;  ///< [1 / radius]
  float g = 0;
};

/// Scattering vertices, each with the direction of travel before it and the light.
struct SmoothExitBatch : VertexBatch {
  /// What `share` says where there may be a way that single precision does not find.
  static constexpr float not_found = -1;

  Floats light_pdf{};  ///< in: of the light, per solid angle
  // In, for choose_lights() (smooth_lights_batch.h): the axis about which the walk may be turned
  // (unit), numbers uniform in [0, 1]; and which light it chose.
  Vectors axis{};
  Floats choice{}, turn{};
  Integers chosen{};
  Floats minimum;  ///< by find_minima(), for the far branches: where they turn
  // Out: share of the vertex's light that leaves towards the light, over the light's density (0:
  // there is no way; or not_found); length inside; where it leaves.
  Floats share, distance;
  Vectors normal;
  // For draw_exits(). In: numbers uniform in [0, 1]. Out: share of the vertex's light that leaves
  // on the near branch in a direction drawn for all, length inside, cosine between up and the
  // normal where it leaves.
  Floats drawn{}, drawn_share, drawn_distance, drawn_cosine;

  /// The ways out from a vertex, one by one.
  SmoothExits exits(std::size_t i, double ior) const { return SmoothExits(ior, up[i], depth2[i]); }

  /// A vertex at p (depth_squared: 1 - |p|^2), with the direction of travel before it.
  void push(Vec3 p, double depth_squared, Vec3 before, Vec3 towards, double pdf) {
    light_pdf[VertexBatch::push(p, depth_squared, before, towards)] = static_cast<float>(pdf);
  }
};

/// How connections and the walk divide the light between them.
enum class Division {
  balanced,   ///< by the balance heuristic (Veach 1995) against the walk's own way there
  connected,  ///< all of it is found by connecting
};

/// The share of one way out, in double precision.
double share_of(const Medium& medium, double ior, const SmoothExit& exit, Vec3 before,
                double light_pdf, Division division);

/// Fills `minimum`, which the far branches ask for.
void find_minima(const SmoothExitMedium& medium, SmoothExitBatch& batch);

/// Fills the batch's results for the way out on one branch.
void find_exits(const SmoothExitMedium& medium, ExitBranch branch, Division division,
                SmoothExitBatch& batch);

/// A way out on the near branch for each vertex of an isotropic medium, drawn uniformly from the
/// directions that get out.
void draw_exits(const SmoothExitMedium& medium, SmoothExitBatch& batch);

}  // namespace translucube
