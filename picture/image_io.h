#pragma once

// This layer holds pictures: as files (here), in the colours of displays (color.h), on contact
// sheets (sheet/). Each library for them stands behind one door. What makes a picture, light and
// its transport, is above it and unknown to it.
//
// The only door to image files: EXR through OpenEXR (exr/), all others through OpenImageIO, in a
// module (oiio/). image_format.h lists the formats.

#include <filesystem>
#include <stdexcept>
#include <string>

#include "picture/image.h"
#include "picture/image_format.h"

namespace translucube {

/// What went wrong with an image file, by its name.
struct ImageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Begins to load what files other than EXR need, 0.3 s, on a thread of its own: for those who will
/// read or write one soon. Nothing else has to call it.
void prepare_image_codecs();
/// Waits for that, if it was begun: the end of the process must not come upon libraries that are
/// being loaded. For the last line of main.
void finish_image_codecs();

/// What a picture carries beside its pixels.
struct ImageMetadata {
  std::string request;     ///< the canonical request, JSON text
  std::string colorspace;  ///< of the pixels: "lin_rec709", "ACEScg", "XYZ" or "<display>/<view>"
  int png_bits = 16;       ///< a channel; 8 where small files matter more
};

/// Reads any image as linear float RGB (a grey image is spread over the channels, alpha is left
/// out). sRGB code values are decoded, also those of a foreign PNG or JPEG that says nothing; the
/// numbers of our own files for other displays, and of any primaries, stay as they are. Throws
/// ImageError for a file that cannot be read, is not finite, or is larger than 2^28 pixels.
Image read_image(const std::filesystem::path& file);

/// The metadata written by write_image, empty strings where there is none. Throws ImageError.
ImageMetadata read_metadata(const std::filesystem::path& file);

/// Writes scene-linear values (EXR: with chromaticities of the colorspace) or display values, with
/// as many bits as the format's row says (a PNG with 8 where metadata says so), and the metadata in
/// the header (PNG text Description, TIFF ImageDescription, EXIF), but for a request that is longer
/// than the format has room for. The same picture gives the same bytes. Throws ImageError; an
/// incomplete file may stay behind: write to a temporary name.
void write_image(const std::filesystem::path& file, const Image& image, ImageFormat format,
                 const ImageMetadata& metadata);

}  // namespace translucube
