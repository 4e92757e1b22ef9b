#pragma once

// Absorbers, and what developing them from bins may be off by.

#include "renderer/optics/material.h"

namespace translucube {

inline SpectralAbsorber narrow_band() {  // a dye: all colours between clear and black
  return {{380, 500, 540, 560, 600, 780}, {0.01, 0.2, 1, 0.8, 0.02, 0}};
}
inline SpectralAbsorber red_glass() { return {{400, 560, 620, 700}, {1, 0.8, 0.1, 0.05}}; }
inline RgbAbsorber plain_rgb() { return {{0.15, 1, 0.5}}; }

/// Of the clear pixel.
struct SpreadError {
  double largest = 0, mean = 0;
};

}  // namespace translucube
