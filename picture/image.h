#pragma once

#include <cstddef>
#include <vector>

namespace translucube {

/// Interleaved float RGB, row 0 at the top.
struct Image {
  int width = 0, height = 0;
  std::vector<float> pixels;  ///< height x width x 3

  Image() = default;
  Image(int w, int h) : width(w), height(h), pixels(std::size_t{3} * w * h, 0.0f) {}
};

}  // namespace translucube
