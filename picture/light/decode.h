#pragma once

#include <span>

#include "picture/image.h"
#include "picture/light/stored_picture.h"

namespace translucube {

/// The formats that environments come in, by their first bytes.
enum class LightFormat { exr, radiance, png, jpeg, tiff, unknown };
LightFormat light_format(std::span<const char> bytes);

/// What a picture means as light: linear R, G, B with the primaries and white of Rec.709 (Bradford
/// from another white), upright, exposure undone, alpha multiplied in linear light. Throws
/// ImageError for channels that are no light and for numbers that are not finite or exceed
/// `brightest`.
Image light_of(const StoredPicture& stored);

/// What a file's bytes mean as light. Throws ImageError, by name for what is not honoured.
Image decode_light(std::span<const char> bytes);

}  // namespace translucube
