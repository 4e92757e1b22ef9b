#pragma once

// The formats in which pictures are written: one table, from which every list of them is told.
//
// To add a format: an enumerator and its row here, and its writer. What OpenImageIO writes needs no
// writer of its own (oiio/picture.cpp makes what it needs of the row); another library has a folder
// beside oiio/ and a value of ImageLibrary, at which image_io.cpp turns to it. Requests,
// negotiation, messages and --help follow by themselves; tests hold api/openapi.json to the table.

#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace translucube {

enum class ImageFormat { png, exr, tiff, jpeg };

enum class ImageLibrary { open_exr, open_image_io };

struct ImageFormatRow {
  ImageFormat format;
  std::string_view name;   ///< in requests, and OpenImageIO's
  std::string_view title;  ///< for people
  std::string_view mime_type;
  std::string_view extension;             ///< with its dot
  std::string_view other_extension = {};  ///< that files of this format may have as well
  ImageLibrary library = ImageLibrary::open_image_io;  ///< reads and writes it
  bool scene_linear = false;  ///< keeps light, in a colour space; else for a display and a view
  int bits = 16;              ///< of a channel; 32: float
  std::string_view compression = "zip";  ///< that OpenImageIO is asked for
  // The libraries are not asked for more than fits into a file: some answer with exit().
  std::size_t longest_request = std::numeric_limits<std::size_t>::max();  ///< [bytes]
  int longest_side = std::numeric_limits<int>::max();                     ///< [pixels]
};

/// In the order of the enumerators, which is that of preference where a client takes any.
inline constexpr std::array<ImageFormatRow, 4> image_formats = {{
    {.format = ImageFormat::png,
     .name = "png",
     .title = "PNG",
     .mime_type = "image/png",
     .extension = ".png"},
    {.format = ImageFormat::exr,
     .name = "exr",
     .title = "EXR",
     .mime_type = "image/x-exr",
     .extension = ".exr",
     .other_extension = ".openexr",
     .library = ImageLibrary::open_exr,
     .scene_linear = true,
     .bits = 32},
    {.format = ImageFormat::tiff,
     .name = "tiff",
     .title = "TIFF",
     .mime_type = "image/tiff",
     .extension = ".tiff",
     .other_extension = ".tif",
     .longest_request = 60'000},  // OpenImageIO reads a description only so far
    {.format = ImageFormat::jpeg,
     .name = "jpeg",
     .title = "JPEG",
     .mime_type = "image/jpeg",
     .extension = ".jpeg",
     .other_extension = ".jpg",
     .bits = 8,
     .compression = "jpeg:95",
     .longest_request = 60'000,  // a segment ends at 64 KiB, of which EXIF and IPTC need some
     .longest_side = 65'500},    // JPEG_MAX_DIMENSION
}};

static_assert([] {
  for (std::size_t i = 0; i < image_formats.size(); ++i)
    if (image_formats[i].format != static_cast<ImageFormat>(i)) return false;
  return true;
}());

constexpr const ImageFormatRow& row_of(ImageFormat format) {
  return image_formats[static_cast<std::size_t>(format)];
}
/// The name by which requests know the format.
constexpr std::string_view name(ImageFormat format) { return row_of(format).name; }
constexpr std::string_view mime_type(ImageFormat format) { return row_of(format).mime_type; }
constexpr bool is_scene_linear(ImageFormat format) { return row_of(format).scene_linear; }

std::optional<ImageFormat> format_named(std::string_view name);
/// The format that a file's extension tells, in upper or lower case.
std::optional<ImageFormat> format_of(const std::filesystem::path& file);

/// A column of the table in a sentence, "a, b or c" where `joint` is " or ": of all formats, or of
/// those for a display.
std::string list_formats(std::string_view ImageFormatRow::*column, std::string_view joint);
std::string list_display_formats(std::string_view ImageFormatRow::*column, std::string_view joint);

}  // namespace translucube
