#pragma once

// EXR files as OpenEXR opens and writes them, for the files of this folder alone.

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include <filesystem>
#include <functional>
#include <string>

#include "picture/image_io_rules.h"

namespace translucube {

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
