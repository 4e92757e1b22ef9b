#pragma once

#include <array>

#include "renderer/base/vec.h"

namespace translucube {

/// The spectral tables' common grid: 380 to 780 nm in steps of 5 nm.
inline constexpr int spectrum_size = 81;
inline constexpr double first_wavelength_nm = 380, wavelength_step_nm = 5;
using SpectrumTable = std::array<double, spectrum_size>;
constexpr double wavelength_nm(int sample) {
  return first_wavelength_nm + sample * wavelength_step_nm;
}

/// CIE 1931 2-degree colour-matching functions (CIE 018:2019, table 6).
extern const SpectrumTable cie_x, cie_y, cie_z;
/// Relative spectral power of CIE standard illuminant D65 (100 at 560 nm; ISO/CIE 11664-2).
extern const SpectrumTable cie_d65;
/// Reflectance-like basis b_c(lambda) >= 0 with b_r + b_g + b_b = 1 everywhere, whose colours under
/// D65 are the Rec.709 primaries (in the spirit of Mallett and Yuksel 2019, "Spectral Primary
/// Decomposition for Rendering with sRGB Reflectance").
extern const SpectrumTable basis_r, basis_g, basis_b;

/// Linear Rec.709 RGB <-> CIE XYZ with D65 at Y = 1 (the white of the tables above).
extern const Matrix3 rgb_to_xyz, xyz_to_rgb;

/// Linear Rec.709 R, G, B of the part that light of this sample's wavelength has in D65 of
/// luminance 1: over all samples they add up to white.
std::array<double, 3> rgb_of_d65(int sample);

}  // namespace translucube
