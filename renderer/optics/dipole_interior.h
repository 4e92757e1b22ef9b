#pragma once

// The paper's model (dipole.h) as the transport meets it.

#include <vector>

#include "renderer/optics/dipole.h"
#include "renderer/optics/lambertian.h"

namespace translucube {

struct DipoleInterior {
  InterfacedLambertian base;
  DipoleRadii radii;
  std::vector<DipoleColor> colors;  ///< one for each lane of the film
  bool absorbing = false;           ///< a colour differs from that of the clear body
  double clear_share =
      1;  ///< 1 - w: of the light that the interface lets in, what crosses the body
  /// What the body without absorber sends out, relative to `base`, of the light that went in here
  /// (plastic's diffuse half, and the dipole where it is local) and elsewhere (the dipole).
  double here = 0, elsewhere = 0;
};

/// The paper's model of a body that is neither empty nor black; every distance on it is within
/// `reach` units.
DipoleInterior make_dipole(const Material& material, const AnyInterface& interface, double unit_mm,
                           double opacity, double reach,
                           const std::vector<Absorption>& absorptions);

}  // namespace translucube
