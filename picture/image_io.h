#pragma once

// The only door to image files: EXR through OpenEXR, which image_io_exr* alone include, all others
// through OpenImageIO, in a module (image_codecs.h).

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "picture/image.h"

namespace translucube {

enum class ImageFormat { png, exr, tiff, jpeg };

std::string_view name(ImageFormat format);       ///< "png", "exr", "tiff", "jpeg"
std::string_view mime_type(ImageFormat format);  ///< "image/png", "image/x-exr", ...
std::optional<ImageFormat> image_format(std::string_view name_or_extension);  ///< "jpg" too

struct ImageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Begins to load what files other than EXR need, 0.3 s, on a thread of its own: for those who will
/// read or write one soon. Nothing else has to call it.
void prepare_image_codecs();

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

/// Writes scene-linear float (EXR: 32-bit float, with chromaticities of the colorspace) or display
/// values (PNG, TIFF: 16 bit, a PNG 8 where metadata says so; JPEG: 8 bit, quality 95), with the
/// metadata in the header (PNG text Description, TIFF ImageDescription, EXIF). TIFF and JPEG have
/// no room for a request of more than 60,000 bytes and go without it. The same picture gives the
/// same bytes. Throws ImageError; an incomplete file may stay behind: write to a temporary name.
void write_image(const std::filesystem::path& file, const Image& image, ImageFormat format,
                 const ImageMetadata& metadata);

/// A picture of many channels, for what is no picture to look at.
struct HalfImage {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< in alphabetical order of layers, R, G, B in each
  std::map<std::string, std::string> attributes;
};

/// Writes planes (channels x height x width, IEEE 754 binary16) as compressed EXR. Throws
/// ImageError; an incomplete file may stay behind: write to a temporary name.
void write_half_image(const std::filesystem::path& file, const HalfImage& image,
                      const std::vector<std::uint16_t>& planes);
/// The attributes are those named "translucube:...". Throws ImageError, also for an EXR that is not
/// of half floats or holds infinities or NaNs.
HalfImage read_half_image(const std::filesystem::path& file, std::vector<std::uint16_t>& planes);

}  // namespace translucube
