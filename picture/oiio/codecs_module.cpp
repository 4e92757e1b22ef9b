// Pictures in the formats that OpenImageIO reads, and as PNG, TIFF and JPEG: the module's table.

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "picture/oiio/codecs.h"
#include "picture/oiio/file.h"
#include "picture/version.h"

namespace translucube {
namespace {

/// A JPEG segment ends at 64 KiB, where libjpeg calls exit(), and OIIO reads a TIFF description
/// only that far: a longer request is left out of these two. (EXIF and IPTC need some room of it.)
constexpr std::size_t max_description_bytes = 60000;
/// Past it libjpeg calls exit() too (JPEG_MAX_DIMENSION).
constexpr int max_jpeg_side = 65500;

// Of PNG, TIFF and JPEG only "ImageDescription" and "Software" survive in all three. The latter is
// "Translucube <version>, pixels in <colour space>".
constexpr std::string_view program = "Translucube ", pixels_in = ", pixels in ";

ImageMetadata metadata_of(const OIIO::ImageSpec& spec) {
  const std::string_view writer = spec.get_string_attribute("Software");
  const std::size_t end = writer.find(pixels_in);
  if (!writer.starts_with(program) || end == writer.npos) return {};
  return {.request = std::string(spec.get_string_attribute("ImageDescription")),
          .colorspace = std::string(writer.substr(end + pixels_in.size()))};
}

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

int channel_index(const OIIO::ImageSpec& spec, char wanted) {
  for (int c = 0; c < spec.nchannels; ++c) {
    const std::string& channel = spec.channelnames[c];
    if (channel.size() == 1 && std::toupper(static_cast<unsigned char>(channel[0])) == wanted)
      return c;
  }
  return -1;
}

/// Where R, G and B are stored: three times the first channel for grey, with or without alpha.
std::array<int, 3> color_channels(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
  const std::array<int, 3> rgb = {channel_index(spec, 'R'), channel_index(spec, 'G'),
                                  channel_index(spec, 'B')};
  if (rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0) return rgb;
  if (spec.nchannels <= 2) {
    const int grey = spec.alpha_channel == 0 && spec.nchannels == 2 ? 1 : 0;
    return {grey, grey, grey};
  }
  fail_image(file, "no channels named R, G and B");
}

void set_metadata(OIIO::ImageSpec& spec, ImageFormat format, const ImageMetadata& metadata) {
  // Only what is true: no other display of config/display.ocio has a tag in OpenImageIO. Not in
  // TIFF: the tag is EXIF there, and OpenImageIO 2.4 spoils the file with it where it writes
  // through an IOProxy (its pull request 4300).
  if (is_srgb(metadata.colorspace) && format != ImageFormat::tiff)
    spec.attribute("oiio:ColorSpace", "sRGB");
  const bool room = format == ImageFormat::png || metadata.request.size() <= max_description_bytes;
  if (room && !metadata.request.empty())  // an empty one trips an assertion of its IPTC writer
    spec.attribute("ImageDescription", metadata.request);
  spec.attribute("Software", std::string(program) + std::string(project_version()) +
                                 std::string(pixels_in) + metadata.colorspace);
  // OpenImageIO would write the time of day: the same picture has the same bytes.
  spec.attribute("DateTime", "");
}

OIIO::ImageSpec output_spec(const Image& image, ImageFormat format, const ImageMetadata& metadata) {
  const bool bytes =
      format == ImageFormat::jpeg || (format == ImageFormat::png && metadata.png_bits == 8);
  OIIO::ImageSpec spec(image.width, image.height, 3,
                       bytes ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16);
  spec.attribute("compression", format == ImageFormat::jpeg ? "jpeg:95" : "zip");
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

  const std::array<int, 3> channels = color_channels(file, spec);
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
  if (format == ImageFormat::jpeg && std::max(image.width, image.height) > max_jpeg_side)
    fail_image(file, "JPEG cannot be wider or higher than 65500 pixels");

  write_image_file(file, format, output_spec(image, format, metadata),
                   [&](OIIO::ImageOutput& output) {
                     return output.write_image(OIIO::TypeDesc::FLOAT, image.pixels.data());
                   });
}

}  // namespace
}  // namespace translucube

extern "C" const translucube::ImageCodecs translucube_image_codecs = {
    translucube::read_picture, translucube::read_picture_metadata, translucube::write_picture};
