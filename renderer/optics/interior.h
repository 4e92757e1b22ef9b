#pragma once

// In this room stands what happens to light at and in a body, in closed form or tabulated: the
// material and its cube, interfaces with their microfacets, media, and interiors (here). It knows
// no shape, no path and no film.
//
// What lies behind the interface, and so which transport runs. To add an interior: its struct with
// its facts, the variant, make_interior(), transport_name(), and what the transport does with it
// (the table in renderer/transport/tracer.h).

#include <string>
#include <variant>
#include <vector>

#include "renderer/optics/dipole.h"
#include "renderer/optics/lambertian.h"
#include "renderer/optics/medium.h"

namespace translucube {

/// What becomes of light that the interface lets in; the transport is compiled by it.
struct InteriorFacts {
  bool open = false;      ///< light crosses the body: a camera may be inside
  bool scatters = false;  ///< light is deflected on its way across
  bool half_space =
      false;             ///< light walks below a point of the surface, to leave at that very point
  bool diffuse = false;  ///< all light leaves where it went in, in all directions
  bool dipole = false;   ///< a share of the light leaves elsewhere as the dipole has it
};

/// a = 1: nothing comes back.
struct BlackInterior {
  static constexpr InteriorFacts facts{};
};
/// s = 0: interface events only.
struct ClearInterior {
  static constexpr InteriorFacts facts{.open = true};
};
/// 0 < s < 1: a random walk.
struct ScatteringInterior {
  static constexpr InteriorFacts facts{.open = true, .scatters = true};
  Medium medium;
};
/// s = 1 with pigments: a random walk in the half space below each point of the surface.
struct DensePigmentInterior {
  static constexpr InteriorFacts facts{.half_space = true};
  Medium medium;  ///< lengths in mean free paths of scattering
};
/// s = 1: closed form.
struct LambertianInterior {
  static constexpr InteriorFacts facts{.diffuse = true};
  InterfacedLambertian base;
  InterfacedLambertian oiled;  ///< the same under the film, where there is one
};
/// The paper's model (dipole.h) as the transport meets it.
struct DipoleInterior {
  static constexpr InteriorFacts facts{.open = true, .dipole = true};
  InterfacedLambertian base;
  DipoleRadii radii;
  std::vector<DipoleColor> colors;  ///< one for each lane of the film
  bool absorbing = false;           ///< a colour differs from that of the clear body
  /// 1 - w: of the light that the interface lets in, what crosses the body.
  double clear_share = 1;
  /// What the body without absorber sends out, relative to `base`, of the light that went in here
  /// (plastic's diffuse half, and the dipole where it is local) and elsewhere (the dipole).
  double here = 0, elsewhere = 0;
};

using AnyInterior = std::variant<BlackInterior, ClearInterior, ScatteringInterior,
                                 DensePigmentInterior, LambertianInterior, DipoleInterior>;

/// The exact optics of a material for a body with this unit.
AnyInterior make_interior(const Material& material, double unit_mm);
/// The paper's model of a body that is neither empty nor black; every distance on it is within
/// `reach` units.
DipoleInterior make_dipole(const Material& material, const AnyInterface& interface, double unit_mm,
                           double opacity, double reach,
                           const std::vector<Absorption>& absorptions);

bool is_open(const AnyInterior& interior);
/// "interface", "clear", "walk", "half-space-walk", "interfaced-lambertian" or "dipole".
std::string transport_name(const AnyInterior& interior);

}  // namespace translucube
