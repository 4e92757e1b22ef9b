#pragma once

#include <array>
#include <optional>

#include "picture/image.h"
#include "picture/stored_picture.h"

namespace translucube {

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// From R, G, B of these primaries to those of Rec.709 (SMPTE RP 177), the white adapted after
/// Bradford (Lam 1985). Throws ImageError where they span no colours.
Matrix3 rgb_to_rec709(const Chromaticities& from);

/// From CIE X, Y, Z, whose white is that of the chromaticities or D65.
Matrix3 xyz_to_rec709(const std::optional<Chromaticities>& white_of);

/// Multiplies every pixel, unless the matrix says nothing.
void convert(Image& image, const Matrix3& matrix);

}  // namespace translucube
