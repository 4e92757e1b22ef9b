#include <variant>

#include "renderer/optics/interior.h"

namespace translucube {

DipoleInterior make_dipole(const Material& material, const AnyInterface& interface, double unit_mm,
                           double opacity, double reach,
                           const std::vector<Absorption>& absorptions) {
  const double reduced = material.coefficients.sigma_s * (1 - material.g) * unit_mm;
  DipoleInterior interior{
      std::visit([](const auto& i) { return InterfacedLambertian(i); }, interface),
      DipoleRadii(reduced, material.ior, reach),
      {}};
  for (const Absorption& a : absorptions) {
    interior.colors.emplace_back(a.absorber, a.sigma_a_peak * unit_mm, reduced, material.ior,
                                 reach);
    interior.absorbing |= a.sigma_a_peak > 0;
  }
  const double entering = interior.base.entering();
  interior.clear_share = 1 - opacity;
  interior.here = opacity * (1 - entering);
  (interior.radii.local() ? interior.here : interior.elsewhere) += entering * interior.radii.mass();
  return interior;
}

}  // namespace translucube
