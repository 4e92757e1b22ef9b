#pragma once

// Pictures of explorable films through any absorber: of those that are kept, and of those that are
// still being traced.

#include "picture/image.h"
#include "renderer/film/absorption.h"
#include "renderer/film/explorable.h"

namespace translucube {

/// The picture through an absorber (lengths in the body's unit). The bits do not depend on
/// `threads` (0: all cores).
Image develop_explorable(const ExplorableFilm& film, const Lane& lane, int threads = 0);
/// `sigma_a_peak` [1/mm], may be infinite.
Image develop_explorable(const ExplorableFilm& film, const Absorber& absorber, double sigma_a_peak,
                         int threads = 0);

/// What the lanes of a scene's explorable films stand for, and the absorber of its own material.
struct ExplorableBasis {
  LengthBins bins;
  double unit_mm = 1;
  Lane own;
};

/// A film that is still being traced, as the float sums stand, through the absorber of its own
/// material or another one: no halves are made of it.
Image develop_shares(const ExplorableBasis& basis, const Film& film);
Image develop_shares(const ExplorableBasis& basis, const Film& film, const Absorber& absorber,
                     double sigma_a_peak);

}  // namespace translucube
