#pragma once

#include <span>

#include "picture/stored_picture.h"

namespace translucube {

/// A Radiance picture (Ward, "Radiance File Formats"): RGBE or XYZE, flat or run-length encoded, in
/// any of its eight orders of pixels. EXPOSURE, COLORCORR, PRIMARIES and GAMMA (of rgbe.h) are
/// told. Throws ImageError.
StoredPicture read_stored_hdr(std::span<const char> bytes);

}  // namespace translucube
