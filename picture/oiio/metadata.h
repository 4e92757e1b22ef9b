#pragma once

#include <OpenImageIO/imageio.h>

#include <string_view>

#include "picture/image_io.h"

namespace translucube {

// Of PNG, TIFF and JPEG only "ImageDescription" and "Software" survive in all three. The latter is
// "Translucube <version>, pixels in <colour space>".
inline constexpr std::string_view program = "Translucube ", pixels_in = ", pixels in ";

inline ImageMetadata metadata_of(const OIIO::ImageSpec& spec) {
  const std::string_view writer = spec.get_string_attribute("Software");
  const std::size_t end = writer.find(pixels_in);
  if (!writer.starts_with(program) || end == writer.npos) return {};
  return {.request = std::string(spec.get_string_attribute("ImageDescription")),
          .colorspace = std::string(writer.substr(end + pixels_in.size()))};
}

}  // namespace translucube
