#include "renderer/light/harmonics.h"

#include <array>
#include <cmath>
#include <numbers>

namespace translucube {
namespace {

/// Ramamoorthi and Hanrahan 2001 (orders 0 to 2), Sloan 2008, "Stupid Spherical Harmonics Tricks",
/// appendix A2 (order 3), with this renderer's axes (z, x, y) in place of theirs (x, y, z).
std::array<double, 16> basis(Vec3 d) {
  const double x = d.z, y = d.x, z = d.y, pi = std::numbers::pi;
  const double c0 = 0.5 * std::sqrt(1 / pi), c1 = std::sqrt(3 / (4 * pi)),
               c2 = 0.5 * std::sqrt(15 / pi), c20 = 0.25 * std::sqrt(5 / pi),
               c33 = 0.25 * std::sqrt(35 / (2 * pi)), c32 = 0.5 * std::sqrt(105 / pi),
               c31 = 0.25 * std::sqrt(21 / (2 * pi)), c30 = 0.25 * std::sqrt(7 / pi);
  return {c0,
          c1 * y,
          c1 * z,
          c1 * x,
          c2 * x * y,
          c2 * y * z,
          c20 * (3 * z * z - 1),
          c2 * x * z,
          0.5 * c2 * (x * x - y * y),
          c33 * y * (3 * x * x - y * y),
          c32 * x * y * z,
          c31 * y * (5 * z * z - 1),
          c30 * z * (5 * z * z - 3),
          c31 * x * (5 * z * z - 1),
          0.5 * c32 * z * (x * x - y * y),
          c33 * x * (x * x - 3 * y * y)};
}

}  // namespace

Rgb radiance_of_harmonics(std::span<const Rgb> coefficients, Vec3 direction) {
  const std::array<double, 16> values = basis(direction);
  Rgb sum;
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    sum += coefficients[i] * static_cast<float>(values[i]);
  return sum;
}

Image image_of_harmonics(std::span<const Rgb> coefficients) {
  // Bilinear between pixels so near each other, order 3 is right to 2e-4.
  Image image(512, 256);
  const double pi = std::numbers::pi;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double theta = pi * (y + 0.5) / image.height;
      const double azimuth = 2 * pi * (0.5 - (x + 0.5) / image.width);
      const Rgb light =
          radiance_of_harmonics(coefficients, {std::sin(theta) * std::sin(azimuth), std::cos(theta),
                                               std::sin(theta) * std::cos(azimuth)});
      float* pixel = &image.pixels[3 * (std::size_t(y) * image.width + x)];
      pixel[0] = light.r, pixel[1] = light.g, pixel[2] = light.b;
    }
  return image;
}

}  // namespace translucube
