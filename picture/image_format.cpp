#include <algorithm>
#include <array>
#include <cctype>

#include "picture/image_io.h"

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

}  // namespace translucube
