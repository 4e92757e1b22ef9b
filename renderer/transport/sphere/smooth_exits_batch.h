#pragma once

// Next-event estimation through the smooth boundary of the unit sphere, many vertices at a time:
// the ways out of smooth_exits.h in SIMD (smooth_exits_batch.cpp), in single precision.

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderer/optics/medium.h"
#include "renderer/transport/sphere/smooth_exits.h"

namespace translucube {

/// What is the same for all vertices of a body.
struct SmoothExitMedium {
  float ior = 1.5f;   ///< >= 1
  float sigma_s = 0;  ///< [1 / radius]
  float g = 0;
};

/// Lights as the vertices choose among them: `candidates` strata of `positions` lights each.
struct LightStrata {
  static constexpr std::size_t candidates = 16, positions = 128, padding = 16;
  static constexpr std::size_t size = candidates * positions;
  using Floats = std::array<float, candidates*(positions + padding)>;

  Floats x{}, y{}, z{};  ///< directions, unit; in each stratum the first ones again at its end
  /// Of the angles by which the candidates are turned.
  std::array<float, candidates> cos_turn, sin_turn;

  LightStrata();
  void set(std::size_t i, Vec3 direction);
};

/// Scattering vertices, each with a direction towards the light (structure of arrays).
struct SmoothExitBatch {
  static constexpr std::size_t capacity = 256;  ///< a multiple of every register's lanes
  /// So that equal places of two arrays do not fall into the same set of a cache.
  static constexpr std::size_t padding = 16;
  using Floats = std::array<float, capacity + padding>;

  std::size_t size = 0;
  // In: outward radius (unit), 1 - rho^2, direction of travel before the vertex (unit), direction
  // to the light (unit), the light's density per solid angle.
  Floats up_x{}, up_y{}, up_z{}, depth2{}, in_x{}, in_y{}, in_z{}, light_x{}, light_y{}, light_z{},
      light_pdf{};
  // In, for choose_lights() and draw_exits(): the axis about which the walk may be turned (unit),
  // numbers uniform in [0, 1]. Out: which light was chosen.
  Floats axis_x{}, axis_y{}, axis_z{}, choice{}, turn{}, drawn{};
  std::array<std::int32_t, capacity> light{};
  Floats minimum;  ///< of find_minima(): where the far branches turn
  // Out: share of the vertex's light that leaves towards the light, over the light's density (0:
  // there is no way; negative: not found, smooth_exits.h finds it); length inside; where it leaves
  // (the normal).
  Floats share, distance, normal_x, normal_y, normal_z;
  // Out, of draw_exits(): share of the vertex's light that leaves on the near branch in a direction
  // drawn for all, length inside, cosine between up and the normal where it leaves.
  Floats drawn_share, drawn_distance, drawn_cosine;

  Vec3 vertex(std::size_t i) const {
    return std::sqrt(1.0 - depth2[i]) * Vec3{up_x[i], up_y[i], up_z[i]};
  }
  Vec3 in(std::size_t i) const { return {in_x[i], in_y[i], in_z[i]}; }
  /// The ways out from a vertex, one by one.
  SmoothExits exits(std::size_t i, double ior) const {
    return SmoothExits(ior, {up_x[i], up_y[i], up_z[i]}, depth2[i]);
  }

  /// `depth_squared`: 1 - |p|^2. Room for one more is the caller's care.
  void push(Vec3 p, double depth_squared, Vec3 in, Vec3 towards, double pdf) {
    const std::size_t i = size++;
    const double scale = 1 / std::fmax(length(p), 1e-12);
    up_x[i] = static_cast<float>(p.x * scale);
    up_y[i] = static_cast<float>(p.y * scale);
    up_z[i] = static_cast<float>(p.z * scale);
    depth2[i] = static_cast<float>(depth_squared);
    in_x[i] = static_cast<float>(in.x);
    in_y[i] = static_cast<float>(in.y);
    in_z[i] = static_cast<float>(in.z);
    light_x[i] = static_cast<float>(towards.x);
    light_y[i] = static_cast<float>(towards.y);
    light_z[i] = static_cast<float>(towards.z);
    light_pdf[i] = static_cast<float>(pdf);
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

/// Chooses a light of the list for each vertex and sets its direction: one out of `candidates`, in
/// proportion to about what leaves towards it on the near branch (resampled importance sampling:
/// Talbot, Cline, Egbert 2005). Each candidate is turned about the vertex's axis by another angle,
/// from a start drawn by `turn`. Multiplies light_pdf by the density of the choice.
void choose_lights(const SmoothExitMedium& medium, const LightStrata& lights, std::size_t position,
                   SmoothExitBatch& batch);

/// Fills `minimum`, which the far branches ask for.
void find_minima(const SmoothExitMedium& medium, SmoothExitBatch& batch);

/// Fills the batch's results for the way out on one branch.
void find_exits(const SmoothExitMedium& medium, ExitBranch branch, Division division,
                SmoothExitBatch& batch);

/// A way out on the near branch for each vertex of an isotropic medium, drawn uniformly from the
/// directions that get out.
void draw_exits(const SmoothExitMedium& medium, SmoothExitBatch& batch);

}  // namespace translucube
