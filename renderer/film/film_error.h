#pragma once

// How far a film is from the picture it would be with samples without end.

#include "renderer/film/film.h"

namespace translucube {

/// Estimate of sqrt(relMSE), relMSE = mean (x - ref)^2 / (ref^2 + 0.01) over channels and pixels,
/// the 0.1 % largest pixels set aside. NaN before the second pass; ref is told from the picture and
/// its surroundings.
double relative_error(const Film& film);

}  // namespace translucube
