#pragma once

#include <array>
#include <cstddef>

#include "renderer/light/environment.h"

namespace translucube {

/// Directions to be looked up in the environment together (structure of arrays).
struct EnvironmentBatch {
  static constexpr std::size_t capacity = 256;  ///< a multiple of every register's lanes
  using Floats = std::array<float, capacity>;

  std::size_t size = 0;
  Floats x, y, z;                                ///< in: unit directions
  std::array<EnvironmentValue, capacity> value;  ///< out

  /// The values of value_from(), in single precision.
  void look_up(const ImageEnvironment& environment);
};

/// Places in the map whose directions are asked for together.
struct MapDirections {
  static constexpr std::size_t capacity = 256;  ///< a multiple of every register's lanes
  using Floats = std::array<float, capacity>;

  std::size_t size = 0;
  Floats u, v;                ///< in: MapCoordinates' x and y
  Floats x, y, z, sin_theta;  ///< out

  /// direction(), in single precision.
  void find(const MapGeometry& map);
};

}  // namespace translucube
