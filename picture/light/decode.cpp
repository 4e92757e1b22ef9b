#include "picture/light/decode.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "picture/exr/stored_exr.h"
#include "picture/image_io.h"
#include "picture/light/icc.h"
#include "picture/light/primaries.h"
#include "picture/light/stored_hdr.h"
#include "picture/light_map.h"
#include "picture/oiio/codecs.h"
#include "picture/srgb.h"

namespace translucube {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 8); ++i)
    list += (i ? ", " : "") + names[i].substr(0, 32);
  return names.size() > 8 ? list + ", ..." : list;
}

/// Where R, G and B (or three times the luminance Y), and alpha where there is one, are stored.
struct ColorChannels {
  std::array<int, 3> rgb{-1, -1, -1};
  int alpha = -1;
};

ColorChannels color_channels(const StoredPicture& stored) {
  const auto find = [&](std::string_view upper, std::string_view lower) {
    const auto found = std::ranges::find_if(
        stored.channels, [&](const std::string& name) { return name == upper || name == lower; });
    return found == stored.channels.end() ? -1 : static_cast<int>(found - stored.channels.begin());
  };
  ColorChannels channels{{find("R", "r"), find("G", "g"), find("B", "b")}, find("A", "a")};
  if (std::ranges::min(channels.rgb) >= 0) return channels;
  const int luminance = find("Y", "y");
  const bool chroma = find("RY", "ry") >= 0 || find("BY", "by") >= 0;
  if (chroma) throw ImageError("luminance and chroma (Y, RY, BY) are not read: store R, G and B");
  if (luminance < 0 || std::ranges::max(channels.rgb) >= 0)
    throw ImageError("its channels (" + listed(stored.channels) +
                     ") are no light: neither R, G and B nor Y alone");
  channels.rgb = {luminance, luminance, luminance};
  return channels;
}

double light_of_number(double number, const TransferCurve& curve) {
  const double size = std::fabs(number);
  double light = size;
  switch (curve.kind) {
    case TransferCurve::Kind::linear:
      return number;
    case TransferCurve::Kind::srgb:
      light = static_cast<double>(srgb_to_linear(static_cast<float>(size)));
      break;
    case TransferCurve::Kind::bt709:  // ITU-R BT.709-6, 1.2
      light = size < 0.081 ? size / 4.5 : std::pow((size + 0.099) / 1.099, 1 / 0.45);
      break;
    case TransferCurve::Kind::gamma:
      light = std::pow(size, curve.gamma);
      break;
  }
  return std::copysign(light, number);
}

void check_numbers(const StoredPicture& stored) {
  if (stored.width <= 0 || stored.height <= 0 || stored.channels.empty())
    throw ImageError("has no pixels");
  for (const double e : stored.exposure)
    if (!std::isfinite(e) || e <= 0) throw ImageError("its exposure is no positive number");
  if (stored.transfer.kind == TransferCurve::Kind::gamma &&
      !(stored.transfer.gamma > 0 && std::isfinite(stored.transfer.gamma)))
    throw ImageError("its gamma is no positive number");
}

/// Every pixel's R, G, B as light in the file's own primaries, alpha multiplied.
Image linear_pixels(const StoredPicture& stored) {
  const ColorChannels channels = color_channels(stored);
  const std::size_t step = stored.channels.size();
  const bool by_profile = !stored.icc_profile.empty();
  Image image(stored.width, stored.height);
  for (std::size_t i = 0; i < stored.pixels(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double number = stored.samples[step * i + channels.rgb[c]];
      const double light = by_profile ? number : light_of_number(number, stored.transfer);
      image.pixels[3 * i + c] = static_cast<float>(light / stored.exposure[c]);
    }
  if (by_profile) apply_icc_profile(stored.icc_profile, channels.rgb[0] == channels.rgb[1], image);
  if (channels.alpha >= 0 && stored.alpha == AlphaKind::unassociated)
    for (std::size_t i = 0; i < stored.pixels(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        image.pixels[3 * i + c] *= stored.samples[step * i + channels.alpha];
  return image;
}

/// The picture with its top row first and its left column first (EXIF 2.3, 4.6.4 A, Orientation).
Image upright(Image image, int orientation) {
  if (orientation == 1) return image;
  if (orientation < 1 || orientation > 8)
    throw ImageError("its orientation " + std::to_string(orientation) + " means nothing");
  const bool turned = orientation >= 5;  // rows are columns
  const bool from_right =
                 orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8,
             from_below =
                 orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  // Of a turned picture "right" and "below" are said of its stored rows and columns.
  Image result(turned ? image.height : image.width, turned ? image.width : image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int u = from_right ? image.width - 1 - x : x, v = from_below ? image.height - 1 - y : y;
      const std::size_t to =
          turned ? std::size_t(u) * result.width + v : std::size_t(v) * result.width + u;
      std::copy_n(&image.pixels[3 * (std::size_t(y) * image.width + x)], 3, &result.pixels[3 * to]);
    }
  return result;
}

void check_light(const Image& image) {
  const auto bad = std::ranges::find_if(
      image.pixels, [](float value) { return !(std::fabs(value) <= brightest); });
  if (bad == image.pixels.end()) return;
  const auto pixel = (bad - image.pixels.begin()) / 3;
  throw ImageError((std::isfinite(*bad) ? "brighter than 1e9" : "not finite") +
                   std::string(" at pixel (") + std::to_string(pixel % image.width) + ", " +
                   std::to_string(pixel / image.width) + ")");
}

}  // namespace

LightFormat light_format(std::span<const char> bytes) {
  const std::string_view start(bytes.data(), std::min<std::size_t>(bytes.size(), 16));
  if (start.starts_with("\x76\x2f\x31\x01")) return LightFormat::exr;
  if (start.starts_with("#?")) return LightFormat::radiance;
  if (start.starts_with("\x89PNG\r\n\x1a\n")) return LightFormat::png;
  if (start.starts_with("\xff\xd8\xff")) return LightFormat::jpeg;
  for (const std::string_view magic : {std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
                                       std::string_view("II+\0", 4), std::string_view("MM\0+", 4)})
    if (start.starts_with(magic)) return LightFormat::tiff;
  return LightFormat::unknown;
}

Image light_of(const StoredPicture& stored) {
  check_numbers(stored);
  Image image = linear_pixels(stored);
  if (stored.icc_profile.empty()) {
    if (stored.is_xyz)
      convert(image, xyz_to_rec709(stored.chromaticities));
    else if (stored.chromaticities)
      convert(image, rgb_to_rec709(*stored.chromaticities));
  }
  check_light(image);
  return upright(std::move(image), stored.orientation);
}

Image decode_light(std::span<const char> bytes) {
  switch (const LightFormat format = light_format(bytes)) {
    case LightFormat::exr:
      return light_of(read_stored_exr(bytes));
    case LightFormat::radiance:
      return light_of(read_stored_hdr(bytes));
    case LightFormat::png:
    case LightFormat::jpeg:
    case LightFormat::tiff:
      return light_of(image_codecs().read_stored(bytes, format));
    case LightFormat::unknown:
      break;
  }
  throw ImageError("neither OpenEXR, Radiance HDR, PNG, JPEG nor TIFF");
}

}  // namespace translucube
