#pragma once

#include <cstdint>

#include "renderer/walk.h"

namespace translucube {

/// A light path on its way back from the camera: an achromatic weight and a length inside the body.
struct Path : Particle {
  Vec3 n;  ///< outward normal, at the boundary
  double weight = 1;
  double roulette = 0;  ///< weight below which chance decides
  double pdf = 0;       ///< of d over the chance that the light there was looked for; 0: it was not
  Vec3 vertex;          ///< where it was scattered last,
  double phase = 0;  ///< the density of d there if light was looked for from there; 0: it was not
  std::uint32_t pixel = 0, events = 0;
  /// Of the dipole model: colour so far, times back at the body from outside.
  std::uint32_t tint = 0, arrivals = 0;
  PathSampler sampler;

  /// Russian roulette; unbiased: the weight lost to those that end is given to those that survive.
  bool survives() {
    if (weight >= roulette) return true;
    if (sampler.rng().uniform() * roulette >= weight) return false;
    weight = roulette;
    return true;
  }
};

}  // namespace translucube
