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

/// What of a map is seen: a plane behind the body hides what lies towards -z.
enum class EnvironmentSide { all, front };

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
    if (side_ == EnvironmentSide::front && direction.z < 0) value.radiance = {};
    return value;
  }
  /// Whether all of a column of cells is hidden.
  bool hides(int column) const;
  struct Texel {
    float r, g, b, weight;  ///< weight: probability of the pixel cell x number of cells
  };
  MapCoordinates coordinates(Vec3 direction) const;
  // Drawing, step by step: each reads a cache line that is not likely to be near.
  struct Draw {
    std::size_t block;
    float rest;  ///< of the number, within the block
    int row;
  };
  Draw draw_block(double u, std::size_t at_least) const;
  void draw_row(Draw& draw) const;
  /// A place in the map, its sin_theta left out.
  MapCoordinates draw_cell(const Draw& draw, double v) const;
  Rgb bilinear(float x, float y) const;
  double cell_pdf(int x, int y, double sin_theta) const;
  struct Tables;
  void build_sampling(Tables& tables);
  void build_irradiance();

  int width_, height_;
  double rotation_rad_;
  EnvironmentSide side_;
  std::span<const Texel> texels_;
  // The chances of the cells, block by block of the map and summed up: over the blocks, and within
  // each over its rows and over its cells (row by row, 1 at its end).
  int blocks_across_ = 0;
  std::span<const double> blocks_;
  std::span<const float> rows_, cells_;
  std::array<Rgb, 9> irradiance_;         ///< coefficients of the polynomials of quadratic_basis()
  std::shared_ptr<const Tables> tables_;  ///< what the spans show: copies share it
};

using Environment = std::variant<UniformEnvironment, ImageEnvironment>;

}  // namespace translucube
