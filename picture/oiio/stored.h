#pragma once

#include <span>

#include "picture/stored_picture.h"

namespace translucube {

/// Has OpenImageIO make what it makes at first use: afterwards read_stored() needs no rights.
void prepare_stored();

/// A PNG, JPEG or TIFF file as it is stored. Throws ImageError.
StoredPicture read_stored(std::span<const char> bytes, LightFormat format);

}  // namespace translucube
