#pragma once

#include <span>

#include "picture/stored_picture.h"

namespace translucube {

/// An OpenEXR file as it is stored: its only part with R, G, B or Y. Throws ImageError, also for
/// what light maps cannot be: deep or subsampled images, integers, cube maps, a display window that
/// is not the data window.
StoredPicture read_stored_exr(std::span<const char> bytes);

}  // namespace translucube
