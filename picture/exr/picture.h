#pragma once

// Pictures as EXR files. EXR goes through OpenEXR itself: environments and films are EXR, and no
// picture waits for more libraries than that.

#include <filesystem>

#include "picture/image_io.h"

namespace translucube {

/// Whether a file is EXR, by its first bytes; false for what cannot be read.
bool is_exr(const std::filesystem::path& file);

// What image_io.h declares, but for the checks of file and pixels.
Image read_exr(const std::filesystem::path& file);
ImageMetadata read_exr_metadata(const std::filesystem::path& file);
void write_exr(const std::filesystem::path& file, const Image& image,
               const ImageMetadata& metadata);

}  // namespace translucube
