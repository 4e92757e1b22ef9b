#pragma once

#include <string>

namespace translucube::test {

/// The smallest environment: a Radiance picture of one grey pixel.
inline const std::string tiny_map =
    "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x80";

}  // namespace translucube::test
