#include "renderer/optics/interior.h"

#include <cmath>

namespace translucube {

AnyInterior make_interior(const Material& material, double unit_mm) {
  if (material.absorption_per_scattering && std::isinf(material.coefficients.sigma_s))
    return DensePigmentInterior{Medium{1, material.g}};
  // Where both are infinite, absorption wins: the body is black.
  if (std::isinf(material.coefficients.sigma_a_peak)) return BlackInterior{};
  if (std::isinf(material.coefficients.sigma_s))
    return LambertianInterior{
        std::visit([](const auto& i) { return InterfacedLambertian(i); }, make_interface(material)),
        InterfacedLambertian(SmoothInterface{material.ior})};
  if (material.coefficients.sigma_s == 0) return ClearInterior{};
  return ScatteringInterior{Medium{material.coefficients.sigma_s * unit_mm, material.g}};
}

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

bool is_open(const AnyInterior& interior) {
  return std::visit([](const auto& i) { return i.facts.open; }, interior);
}

std::string transport_name(const AnyInterior& interior) {
  struct Name {
    std::string operator()(const BlackInterior&) const { return "interface"; }
    std::string operator()(const ClearInterior&) const { return "clear"; }
    std::string operator()(const ScatteringInterior&) const { return "walk"; }
    std::string operator()(const DensePigmentInterior&) const { return "half-space-walk"; }
    std::string operator()(const LambertianInterior&) const { return "interfaced-lambertian"; }
    std::string operator()(const DipoleInterior&) const { return "dipole"; }
  };
  return std::visit(Name{}, interior);
}

}  // namespace translucube
