#pragma once

// Next-event estimation through the smooth boundary of the unit sphere, many vertices at a time:
// the ways out of sphere_exit.h in SIMD (exit_batch.cpp), in single precision.

#include <array>
#include <cstddef>

#include "renderer/medium.h"
#include "renderer/sphere_exit.h"

namespace translucube {

/// What is the same for all vertices of a body.
struct ExitMedium {
  float ior = 1.5f;   ///< >= 1
  float sigma_s = 0;  ///< [1 / radius]
  float g = 0;
};

/// Scattering vertices, each with a direction towards the light (structure of arrays).
struct ExitBatch {
  static constexpr std::size_t capacity = 256;  ///< a multiple of every register's lanes
  using Floats = std::array<float, capacity>;

  std::size_t size = 0;
  // In: outward radius (unit), 1 - rho^2, direction of travel before the vertex (unit), direction
  // to the light (unit), the light's density per solid angle.
  Floats up_x{}, up_y{}, up_z{}, depth2{}, in_x{}, in_y{}, in_z{}, light_x{}, light_y{}, light_z{},
      light_pdf{};
  // Out: share of the vertex's light that leaves towards the light, over the light's density and
  // weighted by the balance heuristic against the walk's own way there (0: there is no way;
  // negative: not found, sphere_exit.h finds it); length inside; where it leaves (the normal).
  Floats share, distance, normal_x, normal_y, normal_z;

  /// `rho`: length of p, > 0. Room for one more is the caller's care.
  void push(Vec3 p, double rho, Vec3 in, Vec3 light, double pdf) {
    const std::size_t i = size++;
    const double scale = 1 / rho;
    up_x[i] = static_cast<float>(p.x * scale);
    up_y[i] = static_cast<float>(p.y * scale);
    up_z[i] = static_cast<float>(p.z * scale);
    depth2[i] = static_cast<float>((1 - rho) * (1 + rho));
    in_x[i] = static_cast<float>(in.x);
    in_y[i] = static_cast<float>(in.y);
    in_z[i] = static_cast<float>(in.z);
    light_x[i] = static_cast<float>(light.x);
    light_y[i] = static_cast<float>(light.y);
    light_z[i] = static_cast<float>(light.z);
    light_pdf[i] = static_cast<float>(pdf);
  }
};

/// The share of one way out, in double precision.
double share(const Medium& medium, double ior, const SphereExit& exit, Vec3 before,
             double light_pdf);

/// Fills the batch's results for the way out on one branch.
void find_exits(const ExitMedium& medium, ExitBranch branch, ExitBatch& batch);

}  // namespace translucube
