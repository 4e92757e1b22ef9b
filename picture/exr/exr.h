#pragma once

// EXR files through OpenEXR itself, for image_io*.cpp alone: environments and films are EXR, and no
// picture waits for more libraries than that.

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include <filesystem>
#include <functional>
#include <string>

#include "picture/image_io.h"

namespace translucube {

/// By its first bytes; false for what cannot be read.
bool is_exr(const std::filesystem::path& file);

// As in image_io.h, but for the checks of file and pixels.
Image read_exr(const std::filesystem::path& file);
ImageMetadata read_exr_metadata(const std::filesystem::path& file);
void write_exr(const std::filesystem::path& file, const Image& image,
               const ImageMetadata& metadata);

/// Reads with `read`, which gets the open file; for the first part where there are several. Throws
/// ImageError, also for deep images, subsampled channels and sizes that check_size() refuses.
void read_exr_file(const std::filesystem::path& file,
                   const std::function<void(Imf::InputFile&)>& read);

/// A header that names this program.
Imf::Header exr_header(int width, int height, Imf::Compression compression);

/// Writes with `write`, which gets the open file, its header written. Throws ImageError.
void write_exr_file(const std::filesystem::path& file, const Imf::Header& header,
                    const std::function<void(Imf::OutputFile&)>& write);

/// The text of an attribute, empty where there is none.
std::string text_attribute(const Imf::Header& header, const std::string& name);

}  // namespace translucube
