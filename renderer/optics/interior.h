#pragma once

#include <string>
#include <variant>

#include "renderer/optics/dipole_interior.h"
#include "renderer/optics/lambertian.h"
#include "renderer/optics/medium.h"

namespace translucube {

/// What lies behind the interface, and so which transport runs.
struct BlackInterior {};  ///< a = 1: nothing comes back
struct ClearInterior {};  ///< s = 0: interface events only
struct ScatteringInterior {
  Medium medium;  ///< 0 < s < 1: random walk
};
struct DensePigmentInterior {
  Medium medium;  ///< s = 1 with pigments: a half space below each point of the surface, lengths in
                  ///< mean free paths of scattering
};
struct LambertianInterior {
  InterfacedLambertian base;   ///< s = 1: closed form
  InterfacedLambertian oiled;  ///< the same under the film, where there is one
};

using AnyInterior = std::variant<BlackInterior, ClearInterior, ScatteringInterior,
                                 DensePigmentInterior, LambertianInterior, DipoleInterior>;

/// The exact optics of a material for a body with this unit.
AnyInterior make_interior(const Material& material, double unit_mm);
/// "interface", "clear", "walk", "half-space-walk", "interfaced-lambertian" or "dipole".
std::string transport_name(const AnyInterior& interior);

}  // namespace translucube
