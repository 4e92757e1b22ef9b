#pragma once

// In this room stands what numbers need: vectors and colours (here), random numbers, spectra,
// tables, SIMD, threads. Whatever knows of light in a scene stands elsewhere.

#include <array>
#include <cmath>

namespace translucube {

/// A point or direction in space. Double precision: depths below a surface of 1e-7 of the body's
/// radius decide dense walks.
struct Vec3 {
  double x = 0, y = 0, z = 0;

  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(double s, Vec3 a) { return a * s; }
  friend constexpr bool operator==(Vec3 a, Vec3 b) = default;
};

constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr double length_squared(Vec3 a) { return dot(a, a); }
inline double length(Vec3 a) { return std::sqrt(length_squared(a)); }
inline Vec3 normalize(Vec3 a) { return a * (1.0 / length(a)); }

/// v / |v| of any length that is not zero: the exponents first, so that no square overflows or
/// vanishes. Of what normalize() can do, to the bit the same.
inline Vec3 direction_of(Vec3 v) {
  const double largest = std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
  const int exponent = std::ilogb(largest);
  return normalize(
      {std::scalbn(v.x, -exponent), std::scalbn(v.y, -exponent), std::scalbn(v.z, -exponent)});
}

inline Vec3 unit_or_zero(Vec3 v) { return v == Vec3{} ? v : direction_of(v); }

/// Linear RGB (Rec.709 primaries, D65 white), any scale, never clamped.
struct Rgb {
  float r = 0, g = 0, b = 0;

  friend constexpr Rgb operator+(Rgb p, Rgb q) { return {p.r + q.r, p.g + q.g, p.b + q.b}; }
  friend constexpr Rgb operator-(Rgb p, Rgb q) { return {p.r - q.r, p.g - q.g, p.b - q.b}; }
  friend constexpr Rgb operator*(Rgb p, Rgb q) { return {p.r * q.r, p.g * q.g, p.b * q.b}; }
  friend constexpr Rgb operator*(Rgb p, float s) { return {p.r * s, p.g * s, p.b * s}; }
  friend constexpr Rgb operator*(float s, Rgb p) { return p * s; }
  constexpr Rgb& operator+=(Rgb q) { return *this = *this + q; }
  friend constexpr bool operator==(Rgb p, Rgb q) = default;
};

/// Relative luminance of linear Rec.709 (ITU-R BT.709-6, item 3.2).
constexpr float luminance(Rgb p) { return 0.2126f * p.r + 0.7152f * p.g + 0.0722f * p.b; }

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// Orthonormal basis with the given z (Duff et al. 2017, "Building an Orthonormal Basis,
/// Revisited").
struct Frame {
  Vec3 x, y, z;

  explicit Frame(Vec3 n) : z(n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    x = {1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    y = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3 to_local(Vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3 to_world(Vec3 v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace translucube
