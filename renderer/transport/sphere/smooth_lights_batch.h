#pragma once

// Lights for the near branch of a smooth sphere, chosen for many vertices at a time by about what
// they bring, in SIMD and single precision.

#include "renderer/transport/sphere/smooth_exits_batch.h"

namespace translucube {

/// Lights as the vertices choose among them: `candidates` strata of `positions` lights each.
struct LightStrata {
  static constexpr std::size_t candidates = 16, positions = 128;
  static constexpr std::size_t size = candidates * positions;
  /// Each stratum ends with its first lights again, as many as any register holds, so that a
  /// register may start anywhere in it.
  static constexpr std::size_t stride = positions + 16;

  VectorArrays<candidates * stride> direction{};  ///< unit
  /// The angles by which the candidates are turned.
  std::array<float, candidates> cos_turn, sin_turn;

  LightStrata();
  void set(std::size_t i, Vec3 direction_of_light);
};

/// Chooses a light of the list for each vertex and sets its direction: one out of `candidates`, in
/// proportion to about what leaves towards it on the near branch (resampled importance sampling:
/// Talbot, Cline, Egbert 2005). Each candidate is turned about the vertex's axis by another angle,
/// from a start drawn by `turn`. Multiplies light_pdf by the density of the choice.
void choose_lights(const SmoothExitMedium& medium, const LightStrata& lights, std::size_t position,
                   SmoothExitBatch& batch);

}  // namespace translucube
