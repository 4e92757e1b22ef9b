// Image files through OpenImageIO 2.4: the only file that includes it.

#include "renderer/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>

namespace translucube {
namespace {

struct FormatInfo {
  ImageFormat format;
  const char* name;
  const char* mime_type;
  std::array<const char*, 2> extensions;
};

constexpr std::array<FormatInfo, 4> formats = {{
    {ImageFormat::png, "png", "image/png", {"png", "png"}},
    {ImageFormat::exr, "exr", "image/x-exr", {"exr", "openexr"}},
    {ImageFormat::tiff, "tiff", "image/tiff", {"tiff", "tif"}},
    {ImageFormat::jpeg, "jpeg", "image/jpeg", {"jpeg", "jpg"}},
}};

const FormatInfo& info(ImageFormat format) {
  return *std::find_if(formats.begin(), formats.end(),
                       [&](const FormatInfo& f) { return f.format == format; });
}

constexpr std::int64_t max_pixels = std::int64_t{1} << 28;

/// A JPEG segment ends at 64 KiB, where libjpeg calls exit(), and OIIO reads a TIFF description
/// only that far: a longer request is left out of these two. (EXIF and IPTC need some room of it.)
constexpr std::size_t max_description_bytes = 60000;
/// Past it libjpeg calls exit() too (JPEG_MAX_DIMENSION).
constexpr int max_jpeg_side = 65500;

constexpr const char* request_attribute = "translucube:request";
constexpr const char* colorspace_attribute = "translucube:colorspace";
/// Of PNG, TIFF and JPEG only "ImageDescription" and "Software" survive in all three.
constexpr std::string_view software = "Translucube " TRANSLUCUBE_VERSION ", pixels in ";

/// The threads belong to the renders: OpenImageIO and OpenEXR decode on the calling one.
void use_one_thread() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", 1);
  });
}

/// Writes to a file and remembers the first error. It reports success to the codec whatever
/// happens, because libjpeg answers a failed write with exit(); finish() tells the truth.
class FileSink final : public OIIO::Filesystem::IOProxy {
 public:
  explicit FileSink(const std::filesystem::path& file)
      : IOProxy(file.string(), Write),
        descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) error_number_ = errno;
  }
  ~FileSink() override { finish(); }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  // Not "file": OpenImageIO would take that for its own class and reach for its FILE*.
  const char* proxytype() const override { return "translucube"; }
  bool opened() const override { return descriptor_ >= 0; }
  std::size_t size() const override { return static_cast<std::size_t>(end_); }

  std::size_t read(void* buffer, std::size_t bytes) override {
    const ssize_t got = ::pread(descriptor_, buffer, bytes, m_pos);
    if (got > 0) m_pos += got;
    return got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  std::size_t write(const void* buffer, std::size_t bytes) override {
    const char* from = static_cast<const char*>(buffer);
    for (std::size_t done = 0; error_number_ == 0 && done < bytes;) {
      const ssize_t put =
          ::pwrite(descriptor_, from + done, bytes - done, m_pos + static_cast<off_t>(done));
      if (put > 0)
        done += static_cast<std::size_t>(put);
      else if (errno != EINTR)
        error_number_ = put < 0 ? errno : EIO;
    }
    m_pos += static_cast<std::int64_t>(bytes);
    end_ = std::max(end_, m_pos);
    return bytes;
  }

  /// 0 if every byte was handed to the system, else the errno of the first failure.
  int finish() {
    if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_number_ == 0) error_number_ = errno;
    descriptor_ = -1;
    return error_number_;
  }

 private:
  int descriptor_;
  std::int64_t end_ = 0;
  int error_number_ = 0;
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
  throw ImageError(file.string() + ": " + why);
}

std::unique_ptr<OIIO::ImageInput> open_input(const std::filesystem::path& file) {
  use_one_thread();
  // OpenImageIO has readers that need no file (names that end in ".null"): ask for a real one.
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    fail(file, error ? error.message() : "not a regular file");
  if (auto input = OIIO::ImageInput::open(file.string())) return input;
  const std::string problem = OIIO::geterror();
  // A stored artifact or a download may have no extension to go by.
  for (const FormatInfo& f : formats) {
    auto input = OIIO::ImageInput::create(f.name);
    OIIO::ImageSpec spec;
    if (input && input->open(file.string(), spec)) return input;
  }
  OIIO::geterror();  // of the attempts: the first one is worth telling
  fail(file, "not a readable image (" + problem + ")");
}

ImageMetadata metadata_of(const OIIO::ImageSpec& spec) {
  ImageMetadata metadata{.request = spec.get_string_attribute(request_attribute),
                         .colorspace = spec.get_string_attribute(colorspace_attribute)};
  const std::string_view writer = spec.get_string_attribute("Software");
  if (metadata.colorspace.empty() && writer.starts_with(software)) {
    metadata.colorspace = writer.substr(software.size());
    metadata.request = spec.get_string_attribute("ImageDescription");
  }
  return metadata;
}

/// The sRGB decoding (IEC 61966-2-1).
float srgb_to_linear(float v) {
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

bool is_srgb(const std::string& colorspace) {
  return colorspace.starts_with("sRGB/") && colorspace != "sRGB/raw";
}

/// Undoes the transfer curve that the file names. OpenImageIO names sRGB for PNG and JPEG that say
/// nothing, and none for EXR, HDR and untagged TIFF; our own files say more than it can.
void linearize(Image& image, const OIIO::ImageSpec& spec) {
  const std::string written = metadata_of(spec).colorspace;
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  const float gamma = spec.get_float_attribute("oiio:Gamma", 1.0f);
  if (written.empty() ? space == "sRGB" : is_srgb(written)) {
    for (float& v : image.pixels) v = srgb_to_linear(v);
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
  fail(file, "no channels named R, G and B");
}

void set_colorspace(OIIO::ImageSpec& spec, ImageFormat format, const std::string& colorspace) {
  if (format != ImageFormat::exr) {
    // Only what is true: no other display of config/display.ocio has a tag in OpenImageIO. Not in
    // TIFF: the tag is EXIF there, and OpenImageIO 2.4 spoils the file with it where it writes
    // through an IOProxy (its pull request 4300).
    if (is_srgb(colorspace) && format != ImageFormat::tiff)
      spec.attribute("oiio:ColorSpace", "sRGB");
    return;
  }
  // Red, green, blue and white xy, as OpenEXR's standard attribute has them.
  std::array<float, 8> xy = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  if (colorspace == "ACEScg")  // AP1 and the ACES white (S-2014-004)
    xy = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  else if (colorspace == "XYZ")
    xy = {1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f / 3.0f, 1.0f / 3.0f};
  else if (colorspace != "lin_rec709")
    return;
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xy.data());
  spec.attribute("oiio:ColorSpace", "Linear");
}

void set_metadata(OIIO::ImageSpec& spec, ImageFormat format, const ImageMetadata& metadata) {
  if (format == ImageFormat::exr) {
    spec.attribute(request_attribute, metadata.request);
    spec.attribute(colorspace_attribute, metadata.colorspace);
    spec.attribute("Software", "Translucube " TRANSLUCUBE_VERSION);
  } else {
    const bool room =
        format == ImageFormat::png || metadata.request.size() <= max_description_bytes;
    if (room && !metadata.request.empty())  // an empty one trips an assertion of its IPTC writer
      spec.attribute("ImageDescription", metadata.request);
    spec.attribute("Software", std::string(software) + metadata.colorspace);
  }
  // OpenImageIO would write the time of day: the same picture has the same bytes.
  spec.attribute("DateTime", "");
}

OIIO::ImageSpec output_spec(const Image& image, ImageFormat format, const ImageMetadata& metadata) {
  OIIO::TypeDesc type = OIIO::TypeDesc::UINT16;
  if (format == ImageFormat::exr) type = OIIO::TypeDesc::FLOAT;
  if (format == ImageFormat::jpeg) type = OIIO::TypeDesc::UINT8;
  OIIO::ImageSpec spec(image.width, image.height, 3, type);
  spec.attribute("compression", format == ImageFormat::jpeg ? "jpeg:95" : "zip");
  spec.attribute("jpeg:subsampling", "4:4:4");
  set_colorspace(spec, format, metadata.colorspace);
  set_metadata(spec, format, metadata);
  return spec;
}

/// Rows of a compressed block of an EXR file with zip compression.
constexpr std::size_t rows_at_once = 16;

template <class Write>
void write_file(const std::filesystem::path& file, ImageFormat format, const OIIO::ImageSpec& spec,
                Write&& write) {
  FileSink sink(file);
  if (!sink.opened()) fail(file, std::strerror(sink.finish()));
  auto output = OIIO::ImageOutput::create(info(format).name);
  if (!output || !output->set_ioproxy(&sink))
    fail(file, "this OpenImageIO cannot write " + std::string(info(format).name));
  const bool written = output->open(file.string(), spec) && write(*output) && output->close();
  const std::string problem = output->geterror();
  output.reset();  // before the sink that it writes to
  if (const int error_number = sink.finish()) fail(file, std::strerror(error_number));
  if (!written) fail(file, "cannot be written (" + problem + ")");
}

}  // namespace

std::string_view name(ImageFormat format) { return info(format).name; }

std::string_view mime_type(ImageFormat format) { return info(format).mime_type; }

std::optional<ImageFormat> image_format(std::string_view name_or_extension) {
  if (name_or_extension.starts_with('.')) name_or_extension.remove_prefix(1);
  std::string lower(name_or_extension);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const FormatInfo& f : formats)
    if (lower == f.extensions[0] || lower == f.extensions[1]) return f.format;
  return std::nullopt;
}

Image read_image(const std::filesystem::path& file) {
  const auto input = open_input(file);
  const OIIO::ImageSpec spec = input->spec();
  if (spec.deep || spec.depth > 1) fail(file, "a deep or volume image, not a flat one");
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) fail(file, "has no pixels");
  if (std::int64_t{spec.width} * spec.height > max_pixels)
    fail(file, std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                   " pixels, more than 2^28");

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
    fail(file, "cannot be read (" + input->geterror() + ")");
  if (!direct)
    for (std::size_t i = 0; i < image.pixels.size() / 3; ++i)
      for (int c = 0; c < 3; ++c)
        image.pixels[3 * i + c] = stored[count * i + (channels[c] - first)];

  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (!std::isfinite(image.pixels[i])) {
      const std::size_t pixel = i / 3, width = image.width;
      fail(file, "not finite at pixel (" + std::to_string(pixel % width) + ", " +
                     std::to_string(pixel / width) + ")");
    }
  linearize(image, spec);
  return image;
}

ImageMetadata read_metadata(const std::filesystem::path& file) {
  return metadata_of(open_input(file)->spec());
}

void write_image(const std::filesystem::path& file, const Image& image, ImageFormat format,
                 const ImageMetadata& metadata) {
  use_one_thread();
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() != std::size_t{3} * image.width * image.height)
    fail(file, "an image without pixels cannot be written");
  if (format == ImageFormat::jpeg && std::max(image.width, image.height) > max_jpeg_side)
    fail(file, "JPEG cannot be wider or higher than 65500 pixels");

  write_file(file, format, output_spec(image, format, metadata), [&](OIIO::ImageOutput& output) {
    return output.write_image(OIIO::TypeDesc::FLOAT, image.pixels.data());
  });
}

void write_half_image(const std::filesystem::path& file, const HalfImage& image,
                      const std::vector<std::uint16_t>& planes) {
  use_one_thread();
  const std::size_t channels = image.channels.size(), width = image.width, height = image.height;
  if (planes.empty() || planes.size() != channels * width * height)
    fail(file, "planes of another size than the image");
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(channels), OIIO::TypeDesc::HALF);
  spec.channelnames = image.channels;
  spec.attribute("compression", "zip");
  for (const auto& [attribute, value] : image.attributes) spec.attribute(attribute, value);
  spec.attribute("Software", "Translucube " TRANSLUCUBE_VERSION);
  spec.attribute("DateTime", "");
  write_file(file, ImageFormat::exr, spec, [&](OIIO::ImageOutput& output) {
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
  const auto input = open_input(file);
  const OIIO::ImageSpec spec = input->spec();
  if (std::string_view(input->format_name()) != "openexr" || spec.format != OIIO::TypeDesc::HALF ||
      spec.deep || spec.tile_width > 0 || spec.x != 0 || spec.y != 0)
    fail(file, "not an EXR of half floats");
  if (std::int64_t{spec.width} * spec.height > max_pixels) fail(file, "more than 2^28 pixels");
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
      fail(file, "cannot be read (" + input->geterror() + ")");
    for (std::size_t c = 0; c < channels; ++c)
      for (std::size_t i = 0; i < (end - y) * width; ++i) {
        const std::uint16_t half = rows[i * channels + c];
        largest = std::max<std::uint16_t>(largest, half & 0x7fffu);
        planes[(c * height + y) * width + i] = half;
      }
  }
  if (largest >= 0x7c00u) fail(file, "holds numbers that are not finite");
  return image;
}

}  // namespace translucube
