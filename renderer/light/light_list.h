#pragma once

#include <cstdint>
#include <vector>

#include "renderer/base/batch.h"
#include "renderer/light/lighting.h"

namespace translucube {

/// Directions drawn from the environment, from which the paths of a tile take their lights: drawing
/// one for each path would cost more than using it. A new list for each few samples keeps the
/// picture free of what one list lacks. With 128 lights a render of R25 takes a fifth less time,
/// but pixels that share a list then err together by more than their spread tells: the image's mean
/// was off by 5 of its standard errors.
struct LightList {
  static constexpr std::uint32_t size = 512;  ///< a power of two

  LightList() {}
  /// Empty where the environment is the same everywhere: there is nothing to look for.
  LightList(const Lighting& lighting, std::uint64_t key);

  bool empty() const { return radiance.empty(); }

  VectorArrays<size> direction;  ///< towards the lights, unit
  std::array<float, size> pdf;   ///< per solid angle
  std::vector<Rgb> radiance;
};

}  // namespace translucube
