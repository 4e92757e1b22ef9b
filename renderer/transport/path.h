#pragma once

#include <algorithm>
#include <cstdint>

#include "renderer/transport/walk.h"

namespace translucube {

/// Below this weight a path survives with probability weight / threshold: low where following it is
/// cheap, high where each turn is a long walk (chosen by relMSE x CPU on the peers' materials).
inline constexpr double roulette_of_clear = 1.0 / 64;
/// The threshold of a scattered path, relative to its weight at the first scattering.
inline constexpr double roulette_of_scattered = 1.0 / 4;
/// The threshold inside a clear body under a rough interface, relative to the weight that went in.
inline constexpr double roulette_of_rough = 1.0 / 8;

/// Each time that light comes back to the body (from a print, or across a hollow) its threshold
/// begins anew, relative to what is left, and both branches are followed once more: where nothing
/// absorbs, that multiplies paths without end. After so many returns the threshold is at least this
/// one, of what the camera saw.
inline constexpr std::uint32_t returns_before_floor = 4;
inline constexpr double roulette_of_returned = 1.0 / 16;

/// A light path on its way back from the camera: an achromatic weight and a length inside the body.
struct Path : Particle {
  Vec3 n;  ///< outward normal, at the boundary
  double weight = 1;
  double roulette = 0;  ///< weight below which chance decides

  /// The density of d per solid angle over the chance that light was looked for along it: then the
  /// path takes its share of that light by the balance heuristic. Or one of the two below.
  double pdf = not_looked_for;
  /// The path takes all the light along d.
  static constexpr double not_looked_for = 0;
  /// The path takes none of it.
  static constexpr double found_by_connecting = -1;

  /// In a sphere, the scatterer where the last flight began.
  struct Vertex {
    Vec3 p;
    double depth2 = 0;  ///< 1 - |p|^2
    double flight = 0;  ///< length from there to the boundary
    double phase = 0;  ///< the density of d from there, per solid angle; 0 where it did not connect
    Vec3 d;            ///< along the flight, where the connector asks for it
    bool connected() const { return phase > 0; }
  } vertex;

  bool colliding = false;  ///< where it is; else a flight comes next
  std::uint32_t pixel = 0, events = 0;
  std::uint32_t start = 0;     ///< of its walk, among those that the connector knows
  std::uint32_t tint = 0;      ///< in the dipole model, the colour so far
  std::uint32_t arrivals = 0;  ///< times back at the body from outside
  PathSampler sampler;

  /// In the unit sphere a point of the boundary is its own normal, to the bit.
  bool on_unit_sphere() const { return p == n; }

  /// Sets the threshold to a share of the weight.
  void play_below(double share) {
    roulette = share * weight;
    if (arrivals > returns_before_floor) roulette = std::max(roulette, roulette_of_returned);
  }

  /// Russian roulette; unbiased: the weight lost to those that end is given to those that survive.
  bool survives() {
    if (weight >= roulette) return true;
    if (sampler.rng().uniform() * roulette >= weight) return false;
    weight = roulette;
    return true;
  }
};

}  // namespace translucube
