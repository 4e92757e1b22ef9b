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
