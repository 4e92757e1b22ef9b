#include "picture/light/primaries.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "picture/image_io.h"

namespace translucube {
namespace {

using Vector3 = std::array<double, 3>;

Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
  Matrix3 product{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) product[i][j] += a[i][k] * b[k][j];
  return product;
}

Vector3 operator*(const Matrix3& m, const Vector3& v) {
  Vector3 product{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) product[i] += m[i][k] * v[k];
  return product;
}

Matrix3 inverse(const Matrix3& m) {
  const auto cofactor = [&](std::size_t i, std::size_t j) {
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
  };
  const double determinant =
      m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  if (!(std::fabs(determinant) > 1e-9)) throw ImageError("its primaries span no colours");
  Matrix3 result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result[j][i] = cofactor(i, j) / determinant;
  return result;
}

/// X, Y, Z of luminance 1.
Vector3 xyz_of(const std::array<double, 2>& xy) {
  if (!(std::fabs(xy[1]) > 1e-6)) throw ImageError("its white has no luminance");
  return {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]};
}

Matrix3 rgb_to_xyz(const Chromaticities& c) {
  Matrix3 m{};
  std::size_t j = 0;
  for (const auto& xy : {c.red, c.green, c.blue}) {
    m[0][j] = xy[0];
    m[1][j] = xy[1];
    m[2][j] = 1 - xy[0] - xy[1];
    ++j;
  }
  const Vector3 amounts = inverse(m) * xyz_of(c.white);
  for (auto& row : m)
    for (std::size_t i = 0; i < 3; ++i) row[i] *= amounts[i];
  return m;
}

Matrix3 bradford(const std::array<double, 2>& from, const std::array<double, 2>& to) {
  constexpr Matrix3 cones{
      {{.8951, .2664, -.1614}, {-.7502, 1.7135, .0367}, {.0389, -.0685, 1.0296}}};
  const Vector3 a = cones * xyz_of(from), b = cones * xyz_of(to);
  Matrix3 scale{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(a[i] > 1e-6)) throw ImageError("its white is none that eyes adapt to");
    scale[i][i] = b[i] / a[i];
  }
  return inverse(cones) * scale * cones;
}

bool finite(const Chromaticities& c) {
  return std::ranges::all_of(std::array{c.red, c.green, c.blue, c.white}, [](const auto& xy) {
    return std::fabs(xy[0]) < 10 && std::fabs(xy[1]) < 10;
  });
}

}  // namespace

Matrix3 rgb_to_rec709(const Chromaticities& from) {
  if (!finite(from)) throw ImageError("its chromaticities are no places in the CIE diagram");
  return inverse(rgb_to_xyz(rec709)) * bradford(from.white, rec709.white) * rgb_to_xyz(from);
}

Matrix3 xyz_to_rec709(const std::optional<Chromaticities>& white_of) {
  const auto white = white_of ? white_of->white : rec709.white;
  return inverse(rgb_to_xyz(rec709)) * bradford(white, rec709.white);
}

void convert(Image& image, const Matrix3& matrix) {
  // Files that name Rec.709, rounded as they like, keep their bits.
  bool nothing = true;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      nothing = nothing && std::fabs(matrix[i][j] - (i == j ? 1 : 0)) < 1e-4;
  if (nothing) return;
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    const std::span<float> p(&image.pixels[i], 3);
    const Vector3 to = matrix * Vector3{p[0], p[1], p[2]};
    std::ranges::transform(to, p.begin(), [](double v) { return static_cast<float>(v); });
  }
}

}  // namespace translucube
