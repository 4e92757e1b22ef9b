#pragma once

#include <limits>

#include "renderer/base/batch.h"
#include "renderer/film/absorption.h"
#include "renderer/film/length_bins.h"

namespace translucube {

/// Floats of a pixel while it is summed up: R, G, B and one that fills the register.
inline constexpr std::size_t pixel_floats = 4;

/// What paths brought to a tile, to be developed together.
struct ContributionBatch : Batch<256> {
  Integers pixel, tint;
  std::array<bool, capacity> carried;  ///< a part of a control variate
  Floats length;                       ///< inside the body, in its unit; 0: never inside
  Floats r, g, b;                      ///< radiance

  void push(std::uint32_t pixel_index, double path_length, std::uint32_t tint_index, Rgb radiance,
            bool is_carried = false) {
    const std::size_t i = size++;
    carried[i] = is_carried;
    const auto rounded = static_cast<float>(path_length);
    pixel[i] = pixel_index;
    tint[i] = tint_index;
    // What was inside at all stays told from what never was (shortest_length).
    length[i] =
        rounded == 0 && path_length > 0 ? std::numeric_limits<float>::denorm_min() : rounded;
    r[i] = radiance.r;
    g[i] = radiance.g;
    b[i] = radiance.b;
  }
};

/// A batch as one lane of the film sees it.
struct DevelopedBatch {
  alignas(64) std::array<float, pixel_floats * ContributionBatch::capacity> light;

  Rgb operator[](std::size_t i) const {
    return {light[pixel_floats * i], light[pixel_floats * i + 1], light[pixel_floats * i + 2]};
  }
  void set(std::size_t i, Rgb value) {
    light[pixel_floats * i] = value.r;
    light[pixel_floats * i + 1] = value.g;
    light[pixel_floats * i + 2] = value.b;
  }
};

/// Lane::apply() of all, in single precision.
void develop(const Lane& lane, const ContributionBatch& batch, DevelopedBatch& developed);

/// Adds them to the pixels of a lane; the number of those that were not finite.
std::size_t add(const ContributionBatch& batch, const DevelopedBatch& developed, float* pixels);

/// Adds the light itself, spread over bins of its length, whose pixels lie `stride` floats apart,
/// but for what is not finite; the number of those.
std::size_t add_spread(const BinSpread& spread, const ContributionBatch& batch, float* pixels,
                       std::size_t stride);

}  // namespace translucube
