#pragma once

#include "renderer/base/batch.h"
#include "renderer/light/environment.h"

namespace translucube {

/// Directions to be looked up in the environment together.
struct EnvironmentBatch : Batch<256> {
  Vectors direction;                             ///< in: unit
  std::array<EnvironmentValue, capacity> value;  ///< out

  /// value_from() for all, in single precision.
  void look_up(const ImageEnvironment& environment);
};

/// Places in the map whose directions are asked for together.
struct MapDirections : Batch<256> {
  Floats u, v;        ///< in: MapCoordinates' x and y
  Vectors direction;  ///< out
  Floats sin_theta;   ///< out

  /// direction() for all, in single precision.
  void find(const MapGeometry& map);
};

}  // namespace translucube
