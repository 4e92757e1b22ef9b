#pragma once

// OpenImageIO pulls in 260 shared libraries, a fifth to a third of a second of dynamic linking. So
// it is linked to a module of its own (picture.cpp and file.cpp of this folder), which is loaded
// when a file first needs it: a picture that is not EXR.

#include <filesystem>
#include <span>

#include "picture/image_io.h"
#include "picture/stored_picture.h"

namespace translucube {

/// What the module can do: what image_io.h declares, but for the checks of sizes and pixels, and
/// what the pictures of strangers hold (oiio/stored.h).
struct ImageCodecs {
  Image (*read)(const std::filesystem::path& file);
  ImageMetadata (*read_metadata)(const std::filesystem::path& file);
  void (*write)(const std::filesystem::path& file, const Image& image, ImageFormat format,
                const ImageMetadata& metadata);
  void (*prepare_stored)();
  StoredPicture (*read_stored)(std::span<const char> bytes, LightFormat format);
};

/// The name under which the module exports its `const ImageCodecs`.
inline constexpr const char* image_codecs_symbol = "translucube_image_codecs";

/// Loads the module at the first call. Throws ImageError.
const ImageCodecs& image_codecs();

}  // namespace translucube
