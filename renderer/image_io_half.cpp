// Images of half floats in many channels.

#include <algorithm>

#include "renderer/image_io_file.h"

namespace translucube {
namespace {

/// Rows of a compressed block of an EXR file with zip compression.
constexpr std::size_t rows_at_once = 16;

}  // namespace

void write_half_image(const std::filesystem::path& file, const HalfImage& image,
                      const std::vector<std::uint16_t>& planes) {
  const std::size_t channels = image.channels.size(), width = image.width, height = image.height;
  if (planes.empty() || planes.size() != channels * width * height)
    fail_image(file, "planes of another size than the image");
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(channels), OIIO::TypeDesc::HALF);
  spec.channelnames = image.channels;
  spec.attribute("compression", "zip");
  for (const auto& [attribute, value] : image.attributes) spec.attribute(attribute, value);
  spec.attribute("Software", "Translucube " TRANSLUCUBE_VERSION);
  spec.attribute("DateTime", "");
  write_image_file(file, ImageFormat::exr, spec, [&](OIIO::ImageOutput& output) {
    std::vector<std::uint16_t> rows(channels * width * rows_at_once);
    for (std::size_t y = 0; y < height; y += rows_at_once) {
      const std::size_t end = std::min(height, y + rows_at_once);
      for (std::size_t c = 0; c < channels; ++c)
        for (std::size_t i = 0; i < (end - y) * width; ++i)
          rows[i * channels + c] = planes[(c * height + y) * width + i];
      if (!output.write_scanlines(static_cast<int>(y), static_cast<int>(end), 0,
                                  OIIO::TypeDesc::HALF, rows.data()))
        return false;
    }
    return true;
  });
}

HalfImage read_half_image(const std::filesystem::path& file, std::vector<std::uint16_t>& planes) {
  const auto input = open_image(file);
  const OIIO::ImageSpec spec = input->spec();
  if (std::string_view(input->format_name()) != "openexr" || spec.format != OIIO::TypeDesc::HALF ||
      spec.deep || spec.tile_width > 0 || spec.x != 0 || spec.y != 0)
    fail_image(file, "not an EXR of half floats");
  if (std::int64_t{spec.width} * spec.height > max_pixels)
    fail_image(file, "more than 2^28 pixels");
  HalfImage image{spec.width, spec.height, spec.channelnames, {}};
  for (const OIIO::ParamValue& value : spec.extra_attribs)
    if (const std::string attribute = value.name().string(); attribute.starts_with("translucube:"))
      image.attributes[attribute] = value.get_string();
  const std::size_t channels = spec.channelnames.size(), width = spec.width, height = spec.height;
  planes.resize(channels * width * height);
  std::vector<std::uint16_t> rows(channels * width * rows_at_once);
  std::uint16_t largest = 0;
  for (std::size_t y = 0; y < height; y += rows_at_once) {
    const std::size_t end = std::min(height, y + rows_at_once);
    if (!input->read_scanlines(0, 0, static_cast<int>(y), static_cast<int>(end), 0, 0,
                               spec.nchannels, OIIO::TypeDesc::HALF, rows.data()))
      fail_image(file, "cannot be read (" + input->geterror() + ")");
    for (std::size_t c = 0; c < channels; ++c)
      for (std::size_t i = 0; i < (end - y) * width; ++i) {
        const std::uint16_t half = rows[i * channels + c];
        largest = std::max<std::uint16_t>(largest, half & 0x7fffu);
        planes[(c * height + y) * width + i] = half;
      }
  }
  if (largest >= 0x7c00u) fail_image(file, "holds numbers that are not finite");
  return image;
}

}  // namespace translucube
