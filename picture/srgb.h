#pragma once

#include <cmath>

namespace translucube {

/// Light of a code value by the sRGB transfer curve (IEC 61966-2-1).
inline float srgb_to_linear(float code) {
  return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f);
}

}  // namespace translucube
