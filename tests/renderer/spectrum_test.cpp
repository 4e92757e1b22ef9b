// The spectral tables against their published check values, and the basis against the constraints
// it was solved under.

#include "renderer/base/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace translucube {
namespace {

double sum(const SpectrumTable& table) { return std::accumulate(table.begin(), table.end(), 0.0); }

int index_of(double wavelength_nm) {
  return static_cast<int>((wavelength_nm - first_wavelength_nm) / wavelength_step_nm);
}

/// CIE XYZ of the reflectance under D65, with Y = 1 for a perfect white.
std::array<double, 3> xyz_under_d65(const SpectrumTable& reflectance) {
  std::array<double, 3> xyz{};
  double white_y = 0;
  for (int i = 0; i < spectrum_size; ++i) {
    const double power = cie_d65[i] * reflectance[i];
    xyz[0] += cie_x[i] * power;
    xyz[1] += cie_y[i] * power;
    xyz[2] += cie_z[i] * power;
    white_y += cie_y[i] * cie_d65[i];
  }
  for (double& value : xyz) value /= white_y;
  return xyz;
}

SpectrumTable perfect_white() {
  SpectrumTable table{};
  table.fill(1.0);
  return table;
}

TEST(Spectrum, ObserverHasThePublishedSums) {
  // CIE 018:2019 / CIE 15:2004 table T.4, last line.
  EXPECT_NEAR(sum(cie_x), 21.371524, 5e-7);
  EXPECT_NEAR(sum(cie_y), 21.371327, 5e-7);
  EXPECT_NEAR(sum(cie_z), 21.371540, 5e-7);
}

TEST(Spectrum, LuminousEfficiencyPeaksAtOneAt555nm) {
  EXPECT_EQ(cie_y[index_of(555)], 1.0);
  for (const double y : cie_y) EXPECT_LE(y, 1.0);
}

TEST(Spectrum, ObserverHasThePublishedValuesAtMarkedWavelengths) {
  EXPECT_EQ(cie_x[index_of(450)], 0.33620);
  EXPECT_EQ(cie_z[index_of(450)], 1.77211);
  EXPECT_EQ(cie_x[index_of(505)], 0.00240);  // the minimum between the two humps
  EXPECT_EQ(cie_x[index_of(600)], 1.06220);
  EXPECT_EQ(cie_y[index_of(600)], 0.63100);
  EXPECT_EQ(cie_x[index_of(780)], 0.000042);
}

TEST(Spectrum, D65Is100At560nmAndHasThePublishedWhitePoint) {
  EXPECT_EQ(cie_d65[index_of(560)], 100.0);
  const auto white = xyz_under_d65(perfect_white());
  const double total = white[0] + white[1] + white[2];
  EXPECT_NEAR(white[0] / total, 0.3127, 1e-4);
  EXPECT_NEAR(white[1] / total, 0.3290, 1e-4);
}

TEST(Spectrum, D65IsLinearBetweenItsDefiningTenNanometrePoints) {
  // ISO/CIE 11664-2 interpolates the defining 10 nm values linearly; six significant digits stay.
  for (int i = 1; i + 1 < spectrum_size; i += 2)
    EXPECT_NEAR(cie_d65[i], (cie_d65[i - 1] + cie_d65[i + 1]) / 2, 5.01e-4) << 380 + 5 * i << " nm";
}

TEST(Spectrum, RgbWhiteIsTheWhiteOfTheTables) {
  const auto white = xyz_under_d65(perfect_white());
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(rgb_to_xyz[k][0] + rgb_to_xyz[k][1] + rgb_to_xyz[k][2], white[k], 1e-14);
}

TEST(Spectrum, RgbColumnsHaveTheChromaticitiesOfRec709) {
  const double expected[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
  for (int c = 0; c < 3; ++c) {
    const double total = rgb_to_xyz[0][c] + rgb_to_xyz[1][c] + rgb_to_xyz[2][c];
    EXPECT_NEAR(rgb_to_xyz[0][c] / total, expected[c][0], 1e-14);
    EXPECT_NEAR(rgb_to_xyz[1][c] / total, expected[c][1], 1e-14);
  }
}

TEST(Spectrum, LuminanceRowIsThatOfRec709WithinTheRoundingOfItsWhite) {
  EXPECT_NEAR(rgb_to_xyz[1][0], 0.2126, 2e-4);
  EXPECT_NEAR(rgb_to_xyz[1][1], 0.7152, 2e-4);
  EXPECT_NEAR(rgb_to_xyz[1][2], 0.0722, 2e-4);
}

TEST(Spectrum, XyzToRgbInvertsRgbToXyz) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      double product = 0;
      for (int k = 0; k < 3; ++k) product += xyz_to_rgb[i][k] * rgb_to_xyz[k][j];
      EXPECT_NEAR(product, i == j ? 1.0 : 0.0, 1e-14);
    }
}

TEST(Spectrum, BasisIsNonNegativeAndSumsToOneAtEveryWavelength) {
  for (int i = 0; i < spectrum_size; ++i) {
    EXPECT_GE(basis_r[i], 0.0);
    EXPECT_GE(basis_g[i], 0.0);
    EXPECT_GE(basis_b[i], 0.0);
    EXPECT_NEAR(basis_r[i] + basis_g[i] + basis_b[i], 1.0, 3e-16) << 380 + 5 * i << " nm";
  }
}

TEST(Spectrum, BasisHasTheColoursOfThePrimariesUnderD65) {
  const SpectrumTable* const basis[3] = {&basis_r, &basis_g, &basis_b};
  for (int c = 0; c < 3; ++c) {
    const auto xyz = xyz_under_d65(*basis[c]);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(xyz[k], rgb_to_xyz[k][c], 1e-12);
  }
}

TEST(Spectrum, BasisIsAsSmoothAsItsOptimum) {
  // The objective's value at the optimum: any edit of the tables that keeps the constraints but
  // is not the smoothest raises it.
  double roughness = 0;
  for (const SpectrumTable* b : {&basis_r, &basis_g, &basis_b})
    for (int i = 0; i + 1 < spectrum_size; ++i) roughness += std::pow((*b)[i + 1] - (*b)[i], 2);
  EXPECT_NEAR(roughness, 0.3687982763, 1e-9);
}

}  // namespace
}  // namespace translucube
