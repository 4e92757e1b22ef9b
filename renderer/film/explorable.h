#pragma once

// Explorable films keep the path lengths: each bin (length_bins.h) holds the light of one length
// inside the body, so that any absorber of any spectrum is developed later as the sum over bins of
// M(l_j) H_j (explorable_develop.h).

#include <cstdint>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/film/length_bins.h"

namespace translucube {

/// An explorable film as it is kept: half floats (IEEE 754 binary16), a power of two apart from the
/// radiance so that neither a sun overflows nor a dim bin vanishes.
struct ExplorableFilm {
  int width = 0, height = 0;
  LengthBins bins;
  double unit_mm = 1;
  std::vector<float> scales;          ///< a bin: radiance = scale x half, a power of two
  std::vector<std::uint16_t> halves;  ///< bins x 3 x height x width
};

/// Expects a film whose lanes are these bins.
ExplorableFilm explorable_film(const LengthBins& bins, double unit_mm, const Film& film);

}  // namespace translucube
