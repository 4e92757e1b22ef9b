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

/// A film that is still being traced, as the float sums stand: no halves are made of it.
Image develop_shares(const LengthBins& bins, const Film& film, const Lane& lane);

}  // namespace translucube
