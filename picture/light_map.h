#pragma once

// Pictures of strangers as light: read in a process without rights.

#include <filesystem>

#include "picture/image.h"
#include "picture/image_io.h"

namespace translucube {

/// The largest number that a pixel of a light map may have, as the request's `constant`.
inline constexpr float brightest = 1e9f;

/// What went wrong with the machine rather than the file, which may be readable another time.
struct ImageUnavailable : ImageError {
  using ImageError::ImageError;
};

/// Reads an OpenEXR, Radiance HDR, PNG, JPEG or TIFF file as linear R, G, B with the primaries of
/// Rec.709 (docs/service.md has what is honoured and what refused). Throws ImageError, and
/// ImageUnavailable where another try may help.
Image read_light_map(const std::filesystem::path& file);

}  // namespace translucube
