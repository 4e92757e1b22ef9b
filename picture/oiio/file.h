#pragma once

// Image files as OpenImageIO 2.4 opens and writes them, for the files of this folder alone.

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "picture/image_io_rules.h"

namespace translucube {

/// The threads belong to the renders: OpenImageIO and OpenEXR decode on the calling one.
void use_one_thread();

/// Throws ImageError.
std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path& file);

/// Writes a file with `write`, which gets the open output and returns false where it fails. Throws
/// ImageError.
void write_image_file(const std::filesystem::path& file, ImageFormat format,
                      const OIIO::ImageSpec& spec,
                      const std::function<bool(OIIO::ImageOutput&)>& write);

}  // namespace translucube
