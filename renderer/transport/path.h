#pragma once

#include <cstdint>

#include "renderer/transport/walk.h"

namespace translucube {

/// A light path on its way back from the camera: an achromatic weight and a length inside the body.
struct Path : Particle {
  Vec3 n;  ///< outward normal, at the boundary
  double weight = 1;
  double roulette = 0;  ///< weight below which chance decides
  /// Of d over the chance that the light there was looked for; 0: it was not.
  double pdf = 0;
  /// In place of pdf: the light there is found by looking for it alone.
  static constexpr double found_by_connecting = -1;
  /// In a sphere, where the last flight began, if light was looked for from there.
  struct Vertex {
    Vec3 p;
    double depth2 = 0;  ///< 1 - |p|^2
    double flight = 0;  ///< length from there to the boundary
    double phase = 0;   ///< the density of d; 0: no light was looked for
  } vertex;
  bool colliding = false;  ///< where it is; else a flight comes next
  std::uint32_t pixel = 0, events = 0;
  std::uint32_t walk = 0;  ///< which walk of the connector's
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
