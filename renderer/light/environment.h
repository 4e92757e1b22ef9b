#pragma once

// In this room stands where light comes from: environments (here), the backdrop behind a body
// (backdrop.h), and the lights that paths look for (light_list.h). A light knows directions and
// densities; it knows no body and no path.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "picture/image.h"
#include "renderer/base/huge_pages.h"
#include "renderer/base/sampler.h"
#include "renderer/base/vec.h"

namespace translucube {

/// Light from a direction, and the density with which sample() would have found it.
struct EnvironmentValue {
  Rgb radiance;
  double pdf = 0;  ///< per solid angle
};
struct EnvironmentSample {
  Vec3 direction;  ///< towards the light, unit
  EnvironmentValue value;
};

/// An environment of the same radiance from everywhere.
struct UniformEnvironment {
  Rgb radiance{1, 1, 1};
};

/// Which part of a map is seen: a plane behind the body hides what lies towards -z, one below it
/// what lies towards -y.
enum class EnvironmentSide { all, front, above };
inline bool is_hidden(EnvironmentSide side, Vec3 direction) {
  return (side == EnvironmentSide::front && direction.z < 0) ||
         (side == EnvironmentSide::above && direction.y < 0);
}

/// The place of a direction in a map.
struct MapCoordinates {
  float x, y;       ///< in pixels, centres at halves
  float sin_theta;  ///< polar angle from +y
};
struct MapGeometry {
  float width, height;  ///< in pixels
  float rotation;       ///< [rad]
};

/// Lat-long image as OpenEXR defines it: u = 0.5 - atan2(x, z) / (2 pi), v = acos(y) / pi, v = 0
/// the top row; bilinear between pixel centres, periodic in u, clamped in v.
class ImageEnvironment {
 public:
  /// `rotation_rad` turns the map about +y, positive from +z towards +x. Pixels finite.
  ImageEnvironment(const Image& image, double rotation_rad, double scale,
                   EnvironmentSide side = EnvironmentSide::all);

  EnvironmentValue value_from(Vec3 direction) const {
    return seen(direction, value_at(coordinates(direction)));
  }
  EnvironmentSide side() const { return side_; }
  /// What the map has there, whether it is hidden or not.
  EnvironmentValue value_at(MapCoordinates at) const;
  MapGeometry geometry() const;
  /// Calls the pixels for value_at() into the cache.
  void prefetch(float x, float y) const;
  /// Draws a direction in proportion to luminance times solid angle, a pixel cell at a time; nearby
  /// u.u give nearby directions, so that stratified numbers give stratified light.
  EnvironmentSample sample(Sample2 u) const;
  /// Many directions, quickest where u.u ascends; what they read of a map larger than the caches is
  /// on its way meanwhile. Directions in single precision.
  std::vector<EnvironmentSample> sample(std::span<const Sample2> u) const;
  Vec3 direction(MapCoordinates at) const;
  /// Irradiance of a surface with normal n, by the spherical harmonics of the orders 0 to 2
  /// (Ramamoorthi and Hanrahan 2001), whose sum is within a few percent, and possibly negative
  /// under a hard sun. Averaged over the normals at an angle from n, the irradiance is their sum
  /// with the Legendre polynomials of the angle's cosine as weights.
  std::array<Rgb, 3> irradiance_by_order(Vec3 n) const;

 private:
  EnvironmentValue seen(Vec3 direction, EnvironmentValue value) const {
    if (is_hidden(side_, direction)) value.radiance = {};
    return value;
  }
  /// Whether all of a column of cells is hidden.
  bool hides(int column) const;
  /// All rows that are not hidden, from the top.
  int rows_seen() const { return side_ == EnvironmentSide::above ? (height_ + 1) / 2 : height_; }
  struct Texel {
    float r, g, b, weight;  ///< weight: probability of the pixel cell x number of cells
  };
  MapCoordinates coordinates(Vec3 direction) const;
  Rgb bilinear(float x, float y) const;
  double cell_pdf(int x, int y, double sin_theta) const;
  /// The light of each cell, 1 in the mean.
  HugePageVector<double> cell_weights(std::span<const Texel> texels) const;
  void build_irradiance();

  int width_, height_;
  double rotation_rad_;
  EnvironmentSide side_;
  struct Tables;
  std::shared_ptr<const Tables> tables_;  ///< copies share them
  std::span<const Texel> texels_;         ///< of the tables
  std::array<Rgb, 9> irradiance_;         ///< coefficients of the polynomials of quadratic_basis()
};

using Environment = std::variant<UniformEnvironment, ImageEnvironment>;

}  // namespace translucube
