#include "picture/image_io.h"

#include <algorithm>
#include <cmath>

#include "picture/exr/picture.h"
#include "picture/image_io_rules.h"
#include "picture/oiio/codecs.h"

namespace translucube {

Image read_image(const std::filesystem::path& file) {
  check_regular_file(file);
  Image image = is_exr(file) ? read_exr(file) : image_codecs().read(file);
  const auto bad =
      std::ranges::find_if(image.pixels, [](float value) { return !std::isfinite(value); });
  if (bad != image.pixels.end()) {
    const auto pixel = (bad - image.pixels.begin()) / 3;
    fail_image(file, "not finite at pixel (" + std::to_string(pixel % image.width) + ", " +
                         std::to_string(pixel / image.width) + ")");
  }
  return image;
}

ImageMetadata read_metadata(const std::filesystem::path& file) {
  check_regular_file(file);
  return is_exr(file) ? read_exr_metadata(file) : image_codecs().read_metadata(file);
}

void write_image(const std::filesystem::path& file, const Image& image, ImageFormat format,
                 const ImageMetadata& metadata) {
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() != std::size_t{3} * image.width * image.height)
    fail_image(file, "an image without pixels cannot be written");
  if (const auto& row = row_of(format); std::max(image.width, image.height) > row.longest_side)
    fail_image(file, std::string(row.title) + " cannot be wider or higher than " +
                         std::to_string(row.longest_side) + " pixels");
  if (row_of(format).library == ImageLibrary::open_exr)
    write_exr(file, image, metadata);
  else
    image_codecs().write(file, image, format, metadata);
}

}  // namespace translucube
