#pragma once

// Pictures of strangers as light: one place decides for every format what each attribute means, and
// refuses by name what it does not honour.

#include <span>

#include "picture/image.h"
#include "picture/stored_picture.h"

namespace translucube {

/// By the first bytes.
LightFormat light_format(std::span<const char> bytes);

/// What a picture means as light: linear R, G, B with the primaries and white of Rec.709 (Bradford
/// from another white), upright, exposure undone, alpha multiplied in linear light. Throws
/// ImageError for channels that are no light and for numbers that are not finite or exceed
/// `brightest`.
Image light_of(const StoredPicture& stored);

/// What a file's bytes mean as light. Throws ImageError, by name for what is not honoured.
Image decode_light(std::span<const char> bytes);

}  // namespace translucube
