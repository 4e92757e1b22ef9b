#pragma once

// What the readers and writers of image files have in common, whichever library does the work.

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include "picture/image_io.h"

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

/// Whether a colorspace as ImageMetadata names it has the sRGB transfer curve.
inline bool is_srgb(const std::string& colorspace) {
  return colorspace.starts_with("sRGB/") && colorspace != "sRGB/raw";
}

/// Undoes the sRGB transfer curve (IEC 61966-2-1).
inline void srgb_to_linear(Image& image) {
  for (float& v : image.pixels)
    v = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

}  // namespace translucube
