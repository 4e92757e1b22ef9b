#pragma once

// What the readers and writers of image files have in common, whichever library does the work.

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "picture/image_io.h"
#include "picture/srgb.h"
#include "picture/stored_picture.h"

namespace translucube {

inline constexpr std::int64_t max_pixels = std::int64_t{1} << 28;

inline constexpr const char* request_attribute = "translucube:request";
inline constexpr const char* colorspace_attribute = "translucube:colorspace";

[[noreturn]] inline void fail_image(const std::filesystem::path& file, const std::string& why) {
  throw ImageError(file.string() + ": " + why);
}

/// Throws ImageError unless `file` is there and a file, not a folder or a device.
inline void check_regular_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    fail_image(file, error ? error.message() : "not a regular file");
}

/// Throws ImageError for sizes that no image has or that no memory is risked for.
inline void check_size(const std::filesystem::path& file, std::int64_t width, std::int64_t height) {
  if (width <= 0 || height <= 0) fail_image(file, "has no pixels");
  if (width > max_pixels || height > max_pixels || width * height > max_pixels)
    fail_image(file,
               std::to_string(width) + " x " + std::to_string(height) + " pixels, more than 2^28");
}

/// Throws ImageError where so few bytes cannot hold so many pixels: no format packs more than
/// deflate's 1032 bytes of eight pixels each to a byte.
inline void check_not_cut_off(std::int64_t width, std::int64_t height, std::size_t bytes) {
  constexpr double densest = 8 * 1032;
  if (double(width) * double(height) > densest * double(bytes)) throw ImageError("cut off");
}

/// Whether a colorspace as ImageMetadata names it has the sRGB transfer curve.
inline bool is_srgb(const std::string& colorspace) {
  return colorspace.starts_with("sRGB/") && colorspace != "sRGB/raw";
}

/// What a colorspace as ImageMetadata names it says of a stored picture's numbers: nothing where it
/// is empty. Throws ImageError for those of a display other than sRGB.
inline void read_own_colorspace(const std::string& colorspace, StoredPicture& stored) {
  if (colorspace.empty()) return;
  if (is_srgb(colorspace))
    stored.transfer.kind = TransferCurve::Kind::srgb;
  else if (colorspace.find('/') != colorspace.npos)
    throw ImageError("holds the code values of a display (" + colorspace.substr(0, 64) +
                     "), not light");
  else
    stored.transfer.kind = TransferCurve::Kind::linear;
}

/// Undoes the sRGB transfer curve.
inline void srgb_to_linear(Image& image) {
  for (float& value : image.pixels) value = srgb_to_linear(value);
}

/// Where R, G and B are stored among channels of these names: three times the one of grey where
/// there is but one, with or without alpha. Throws ImageError.
inline std::array<int, 3> color_channels(const std::filesystem::path& file,
                                         std::span<const std::string> names) {
  const int count = static_cast<int>(names.size());
  std::array<int, 3> rgb{-1, -1, -1};
  for (int i = count - 1; i >= 0; --i)
    for (int c = 0; c < 3; ++c)
      if (names[i].size() == 1 && (names[i][0] == "RGB"[c] || names[i][0] == "rgb"[c])) rgb[c] = i;
  if (rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0) return rgb;
  if (count < 1 || count > 2) fail_image(file, "no channels named R, G and B");
  const int grey = count == 2 && names[0] == "A" ? 1 : 0;
  return {grey, grey, grey};
}

}  // namespace translucube
