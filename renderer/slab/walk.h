#pragma once

// Random walks of light through a flat slab, from the light's side. A slab knows one coordinate
// only: the depth z across it, in units of its thickness, and mu = the cosine of the direction of
// travel with +z; interfaces and scatterers are isotropic about z, so no azimuth is carried.
//
// Absorption is not traced: a tally keeps the weight of the light that leaves over the length it
// travelled inside, and any absorber is developed from it (design.md section 1).

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "renderer/optics/interface.h"
#include "renderer/optics/interior.h"

namespace translucube {

enum class Incidence { normal, diffuse };  ///< collimated along +z, or Lambertian on the face z = 0

/// Where light leaves. Beside reflection: the angle from the direction of normal incidence, which
/// haze and clarity ask for; diffuse incidence has no such direction, all its light is `wide`.
enum class SlabExit { reflected, core, ring, wide };
inline constexpr int slab_exits = 4;
/// Half angles of the cones around the incident direction: core < ring < wide [degrees].
inline constexpr double core_half_angle_deg = 0.5, ring_half_angle_deg = 2.5;
inline double sin2_of_degrees(double degrees) {
  const double sine = std::sin(degrees * std::numbers::pi / 180);
  return sine * sine;
}

/// A slab of thickness 1.
struct SlabBody {
  AnyInterface interface;  ///< the same on both faces
  AnyInterior interior;
  double least_sigma_a = 0;  ///< of all channels [1 / thickness]: may end paths that none sees
};

/// Whether anything of this body is left to chance.
bool needs_walks(const SlabBody& body);

/// Weight over length for every exit. The nodes are linear in 1 + sigma_peak l within an octave:
/// an exponential absorption exp(-sigma l), sigma <= sigma_peak, is interpolated to 4e-6.
class SlabTally {
 public:
  static constexpr int segment_bits = 7, octaves = 40;
  static constexpr std::size_t nodes = (std::size_t{octaves} << segment_bits) + 1;

  explicit SlabTally(double sigma_a_peak);

  void add(SlabExit exit, double weight, double length);
  const std::vector<double>& weights(SlabExit exit) const {
    return weights_[static_cast<int>(exit)];
  }
  std::size_t used() const { return used_; }  ///< nodes from here on are empty
  /// sigma_peak l at a node.
  static double depth_at(std::size_t node);

 private:
  double sigma_a_peak_;
  std::array<std::vector<double>, slab_exits> weights_;
  std::size_t used_ = 1;
};

/// Adds histories [first, first + count) of unit incident weight each. Light that crosses smooth
/// faces without meeting a scatterer is left out: slab_direct.h has it in closed form.
void walk_slab(const SlabBody& body, Incidence incidence, std::uint64_t key, std::uint64_t first,
               std::uint64_t count, SlabTally& tally);

/// The same with every flight walked one by one, as a reference for tests.
void walk_slab_analog(const SlabBody& body, Incidence incidence, std::uint64_t key,
                      std::uint64_t first, std::uint64_t count, SlabTally& tally);

}  // namespace translucube
