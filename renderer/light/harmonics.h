#pragma once

#include <span>

#include "picture/image.h"
#include "renderer/base/vec.h"

namespace translucube {

/// Light by real, orthonormal spherical harmonics: coefficients of the orders l = 0 to 3, within
/// each m = -l to l (1, 4, 9 or 16 of them), about +y as the pole, with +z where the azimuth is 0
/// and +x where it is 90 degrees: Y_1 = sqrt(3 / 4 pi) (x, y, z) in this order.
Rgb radiance_of_harmonics(std::span<const Rgb> coefficients, Vec3 direction);

/// As a lat-long map (environment.h).
Image image_of_harmonics(std::span<const Rgb> coefficients);

}  // namespace translucube
