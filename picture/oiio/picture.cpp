// Pictures in the formats that OpenImageIO reads, and in those of image_format.h that it writes:
// what the module exports.

#include <algorithm>
#include <array>
#include <cmath>

#include "picture/oiio/codecs.h"
#include "picture/oiio/file.h"
#include "picture/oiio/metadata.h"
#include "picture/oiio/stored.h"
#include "picture/version.h"

namespace translucube {
namespace {

/// Undoes the transfer curve that the file names. OpenImageIO names sRGB for PNG and JPEG that say
/// nothing, and none for EXR, HDR and untagged TIFF; our own files say more than it can.
void linearize(Image& image, const OIIO::ImageSpec& spec) {
  const std::string written = metadata_of(spec).colorspace;
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  const float gamma = spec.get_float_attribute("oiio:Gamma", 1.0f);
  if (written.empty() ? space == "sRGB" : is_srgb(written)) {
    srgb_to_linear(image);
  } else if (written.empty() && space.starts_with("Gamma") && gamma > 0.0f && gamma != 1.0f) {
    for (float& v : image.pixels) v = std::copysign(std::pow(std::abs(v), gamma), v);
  }
}

void set_metadata(OIIO::ImageSpec& spec, ImageFormat format, const ImageMetadata& metadata) {
  // Only what is true: no other display of config/display.ocio has a tag in OpenImageIO. Not in
  // TIFF: the tag is EXIF there, and OpenImageIO 2.4 spoils the file with it where it writes
  // through an IOProxy (its pull request 4300).
  if (is_srgb(metadata.colorspace) && format != ImageFormat::tiff)
    spec.attribute("oiio:ColorSpace", "sRGB");
  const bool room = metadata.request.size() <= row_of(format).longest_request;
  if (room && !metadata.request.empty())  // an empty one trips an assertion of its IPTC writer
    spec.attribute("ImageDescription", metadata.request);
  spec.attribute("Software", std::string(program) + std::string(project_version()) +
                                 std::string(pixels_in) + metadata.colorspace);
  // OpenImageIO would write the time of day: the same picture has the same bytes.
  spec.attribute("DateTime", "");
}

OIIO::TypeDesc type_of(int bits) {
  switch (bits) {
    case 8:
      return OIIO::TypeDesc::UINT8;
    case 16:
      return OIIO::TypeDesc::UINT16;
    default:
      return OIIO::TypeDesc::FLOAT;
  }
}

OIIO::ImageSpec output_spec(const Image& image, ImageFormat format, const ImageMetadata& metadata) {
  const ImageFormatRow& row = row_of(format);
  const int bits = format == ImageFormat::png ? metadata.png_bits : row.bits;
  OIIO::ImageSpec spec(image.width, image.height, 3, type_of(bits));
  spec.attribute("compression", std::string(row.compression));
  spec.attribute("jpeg:subsampling", "4:4:4");
  set_metadata(spec, format, metadata);
  return spec;
}

Image read_picture(const std::filesystem::path& file) {
  const auto input = open_image(file);
  const OIIO::ImageSpec spec = input->spec();
  if (spec.deep || spec.depth > 1) fail_image(file, "a deep or volume image, not a flat one");
  check_size(file, spec.width, spec.height);
  if (spec.nchannels <= 0) fail_image(file, "has no pixels");

  const std::array<int, 3> channels = color_channels(file, spec.channelnames);
  const int first = *std::min_element(channels.begin(), channels.end());
  const int count = *std::max_element(channels.begin(), channels.end()) + 1 - first;
  Image image(spec.width, spec.height);
  const std::array<int, 3> in_order = {first, first + 1, first + 2};
  const bool direct = channels == in_order;
  std::vector<float> stored;
  if (!direct) stored.resize(std::size_t(count) * spec.width * spec.height);
  if (!input->read_image(0, 0, first, first + count, OIIO::TypeDesc::FLOAT,
                         direct ? image.pixels.data() : stored.data()))
    fail_image(file, "cannot be read (" + input->geterror() + ")");
  if (!direct)
    for (std::size_t i = 0; i < image.pixels.size() / 3; ++i)
      for (int c = 0; c < 3; ++c)
        image.pixels[3 * i + c] = stored[count * i + (channels[c] - first)];

  linearize(image, spec);
  return image;
}

ImageMetadata read_picture_metadata(const std::filesystem::path& file) {
  return metadata_of(open_image(file)->spec());
}

void write_picture(const std::filesystem::path& file, const Image& image, ImageFormat format,
                   const ImageMetadata& metadata) {
  write_image_file(file, format, output_spec(image, format, metadata),
                   [&](OIIO::ImageOutput& output) {
                     return output.write_image(OIIO::TypeDesc::FLOAT, image.pixels.data());
                   });
}

}  // namespace
}  // namespace translucube

extern "C" const translucube::ImageCodecs translucube_image_codecs = {
    translucube::read_picture, translucube::read_picture_metadata, translucube::write_picture,
    translucube::prepare_stored, translucube::read_stored};
