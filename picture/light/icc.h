#pragma once

#include <cstdint>
#include <span>

#include "picture/image.h"

namespace translucube {

/// Turns numbers of an ICC profile's colour space (RGB, or grey, then of the first channel) into
/// linear light of Rec.709, relative colorimetric. Throws ImageError for what is no such profile.
void apply_icc_profile(std::span<const std::uint8_t> profile, bool grey, Image& image);

}  // namespace translucube
