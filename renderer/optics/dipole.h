#pragma once

// The dipole (Jensen, Marschner, Levoy, Hanrahan 2001, "A Practical Model for Subsurface Light
// Transport"), as the paper of the translucency cube uses it (Gerardin et al. 2019, section 2):
//
//   L(x_o, w_o) = (1 - w) L_dielectric + w L_plastic + L_dipole,   w the cube's scattering s
//
//   L_dipole  = int_A int_2pi S_d(x_i, w_i; x_o, w_o) L_i(w_i) |cos_i| dw_i dA,
//               S_d = T(w_i) R_d(|x_o - x_i|) T(w_o) / pi                          (eq. 5)
//   R_d(r)    = alpha' / 4 pi sum over z = z_r, z_v of
//               z (sigma_tr + 1/d) exp(-sigma_tr d) / d^2,   d^2 = r^2 + z^2        (eq. 4)
//   z_r = 1 / sigma_t',  z_v = z_r (1 + 4/3 A),  sigma_tr = sqrt(3 sigma_a sigma_t'),
//   sigma_s' = sigma_s (1 - g),  sigma_t' = sigma_a + sigma_s',  alpha' = sigma_s' / sigma_t',
//   A = (1 + F_dr) / (1 - F_dr),  F_dr the diffuse internal reflectance of the smooth interface.
//
// L_dielectric is the transport of the empty body (s = 0), smooth or rough, with its absorber.
// L_plastic is the interface's own reflection over an interfaced Lambertian base B (lambertian.h).
// T is the share of light that the interface lets in, and r_e the part of diffuse light that it
// reflects from outside: T T / pi = (1 - r_e) B. In the limit of density R_d becomes local, so that
// the dipole alone is (1 - r_e) R_d B: eq. 5 lacks the light that the interface sends back and that
// tries again. Plastic's diffuse half is what is missing, r_e R_d B, where a renderer's free choice
// (Mitsuba: 0.5) would be added a second time. So w = 1 is exactly the opaque plastic.
//
// The model does not conserve energy in between: the dipole comes in full on top of what the
// dielectric already transmits, and it takes any body for a half space. By how much is measured
// (docs/accuracy.md), not corrected.
//
// Absorption acts on R_d for each wavelength: an operator from RGB to RGB over r, as a lane's is
// over the path length (absorption.h). Sampling never depends on the colour of the light.

#include <array>

#include "renderer/base/color_operator.h"
#include "renderer/base/vec.h"
#include "renderer/optics/material.h"

namespace translucube {

/// R_d of one wavelength. Lengths in any unit, coefficients in 1 / unit.
class DipoleProfile {
 public:
  /// sigma_a finite; reduced_sigma_s > 0, +infinity for the limit in which R_d is local.
  DipoleProfile(double sigma_a, double reduced_sigma_s, double ior);

  double z_real() const { return z_[0]; }
  /// R_d(r) [1 / unit^2] (eq. 4). Finite densities only.
  double reflectance(double r) const;
  /// Integral of R_d over the plane: alpha' / 2 (1 + exp(-4/3 A k)) exp(-k), k^2 = 3 (1 - alpha').
  double total() const { return strength_[0] + strength_[1]; }
  /// Integral of R_d over the disc of radius r, in closed form.
  double within(double r) const;
  /// A radius <= reach of the density 2 pi r R_d(r) / within(reach). `u` in [0, 1).
  double sample(double u, double reach) const;

 private:
  double share(int source, double r) const;

  double albedo_, sigma_tr_;
  std::array<double, 2> z_;         ///< of the real and of the virtual source
  std::array<double, 2> strength_;  ///< integral of each source's part of R_d
};

/// Where light that comes out at a point went in: radii drawn from R_d of the body without its
/// absorber, so that no absorber changes what is traced (as in transport.cpp).
class DipoleRadii {
 public:
  /// `reach`: the largest distance between two points of the surface. Lengths in one unit.
  DipoleRadii(double reduced_sigma_s, double ior, double reach);

  /// R_d is narrower than any shape resolves: light comes out where it went in.
  bool local() const { return profile_.z_real() < smallest_radius; }
  /// Integral of R_d over the disc of radius reach; 1 where it is local.
  double mass() const { return mass_; }
  double reach() const { return reach_; }
  double reflectance(double r) const { return profile_.reflectance(r); }
  /// A radius of the density 2 pi r reflectance(r) / mass().
  double sample(double u) const { return profile_.sample(u, reach_); }

 private:
  /// Radii below this are not told apart, in units of the body: the intersection of
  /// single-precision meshes is no better.
  static constexpr double smallest_radius = 1e-8;

  DipoleProfile profile_;
  double reach_, mass_;
};

/// What an absorber makes of R_d, as operators on colours.
class DipoleColor {
 public:
  /// Coefficients in 1 / unit; sigma_a_peak may be +infinity.
  DipoleColor(const Absorber& absorber, double sigma_a_peak, double reduced_sigma_s, double ior,
              double reach);

  /// R_d(r) over that of the body without absorber, for r <= reach.
  ColorOperator at(double r) const { return table_.at(1 + r / z_min_); }
  /// The integral of R_d over the plane.
  const ColorOperator& total() const { return total_; }

 private:
  double z_min_ = 1;
  ColorOperator total_{};
  ColorOperatorTable table_;  ///< over 1 + r / z_min
};

}  // namespace translucube
