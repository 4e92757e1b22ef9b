// The RGB <-> XYZ matrices of the tables in spectrum_tables.cpp, and the colours of wavelengths.

#include "renderer/base/spectrum.h"

namespace translucube {
namespace {

/// CIE XYZ of the D65 table with Y = 1, that is sum(cmf d65) / sum(y d65) over the tables' grid:
/// xy = (0.31272, 0.32903). The tables' own white, not the rounded (0.3127, 0.3290), so that a
/// spectrum that is D65 develops to R = G = B exactly. A literal, because the tables are defined in
/// another translation unit; spectrum_test.cpp holds it to their sums.
constexpr std::array<double, 3> white = {0.9504296621098933, 1.0, 1.0888005680506738};

/// Chromaticities of the Rec.709 primaries (ITU-R BT.709-6, item 1.3): {x, y} of R, G, B.
constexpr double primaries[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};

constexpr double cofactor(const Matrix3& m, int row, int column) {
  const int r0 = (row + 1) % 3, r1 = (row + 2) % 3, c0 = (column + 1) % 3, c1 = (column + 2) % 3;
  return m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
}

constexpr Matrix3 inverse(const Matrix3& m) {
  const double determinant =
      m[0][0] * cofactor(m, 0, 0) + m[0][1] * cofactor(m, 0, 1) + m[0][2] * cofactor(m, 0, 2);
  Matrix3 result{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result[i][j] = cofactor(m, j, i) / determinant;
  return result;
}

/// Columns are the XYZ of the primaries, scaled so that they add up to the white (SMPTE RP 177).
constexpr Matrix3 primary_matrix() {
  Matrix3 directions{};
  for (int c = 0; c < 3; ++c) {
    const double x = primaries[c][0], y = primaries[c][1];
    directions[0][c] = x / y;
    directions[1][c] = 1.0;
    directions[2][c] = (1.0 - x - y) / y;
  }
  const Matrix3 solve = inverse(directions);
  Matrix3 result{};
  for (int c = 0; c < 3; ++c) {
    const double luminance_share =
        solve[c][0] * white[0] + solve[c][1] * white[1] + solve[c][2] * white[2];
    for (int k = 0; k < 3; ++k) result[k][c] = directions[k][c] * luminance_share;
  }
  return result;
}

}  // namespace

constinit const Matrix3 rgb_to_xyz = primary_matrix();
constinit const Matrix3 xyz_to_rgb = inverse(primary_matrix());

std::array<double, 3> rgb_of_d65(int sample) {
  static const double luminance = [] {
    double sum = 0;
    for (int i = 0; i < spectrum_size; ++i) sum += cie_y[i] * cie_d65[i];
    return sum;
  }();
  const std::array<double, 3> xyz{cie_x[sample], cie_y[sample], cie_z[sample]};
  std::array<double, 3> rgb{};
  for (int row = 0; row < 3; ++row)
    for (int j = 0; j < 3; ++j)
      rgb[row] += xyz_to_rgb[row][j] * xyz[j] * cie_d65[sample] / luminance;
  return rgb;
}

}  // namespace translucube
