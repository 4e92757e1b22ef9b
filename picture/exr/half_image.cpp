#include "picture/half_image.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <tuple>

#include "picture/exr/file.h"
#include "picture/exr/picture.h"

namespace translucube {
namespace {

Imf::FrameBuffer frame_buffer(const HalfImage& image, const std::vector<std::uint16_t>& planes) {
  Imf::FrameBuffer pixels;
  const std::size_t plane = std::size_t(image.width) * image.height;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    // OpenEXR takes one kind of slice for reading and for writing.
    auto* const first = const_cast<std::uint16_t*>(planes.data() + c * plane);
    pixels.insert(image.channels[c],
                  Imf::Slice(Imf::HALF, reinterpret_cast<char*>(first), sizeof(std::uint16_t),
                             sizeof(std::uint16_t) * image.width));
  }
  return pixels;
}

/// The alphabet's order of layers, R, G, B in each.
bool comes_before(const std::string& a, const std::string& b) {
  const auto key = [](const std::string& name) {
    const auto dot = name.rfind('.');
    const std::string layer = dot == name.npos ? std::string() : name.substr(0, dot);
    const std::string channel = dot == name.npos ? name : name.substr(dot + 1);
    return std::tuple(layer, std::string("RGB").find(channel), channel);
  };
  return key(a) < key(b);
}

}  // namespace

void write_half_image(const std::filesystem::path& file, const HalfImage& image,
                      const std::vector<std::uint16_t>& planes) {
  if (planes.empty() ||
      planes.size() != image.channels.size() * std::size_t(image.width) * image.height)
    fail_image(file, "planes of another size than the image");
  Imf::Header header = exr_header(image.width, image.height, Imf::ZIP_COMPRESSION);
  for (const std::string& channel : image.channels)
    header.channels().insert(channel, Imf::Channel(Imf::HALF));
  for (const auto& [attribute, value] : image.attributes)
    header.insert(attribute, Imf::StringAttribute(value));
  write_exr_file(file, header, [&](Imf::OutputFile& output) {
    output.setFrameBuffer(frame_buffer(image, planes));
    output.writePixels(image.height);
  });
}

HalfImage read_half_image(const std::filesystem::path& file, std::vector<std::uint16_t>& planes) {
  check_regular_file(file);
  if (!is_exr(file)) fail_image(file, "not an EXR of half floats");
  HalfImage image;
  read_exr_file(file, [&](Imf::InputFile& input) {
    const Imf::Header& header = input.header();
    const Imath::Box2i& window = header.dataWindow();
    bool halves = !header.hasTileDescription() && window.min == Imath::V2i(0, 0);
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
      halves = halves && it.channel().type == Imf::HALF;
      image.channels.emplace_back(it.name());
    }
    if (!halves) fail_image(file, "not an EXR of half floats");
    std::ranges::sort(image.channels, comes_before);
    for (auto it = header.begin(); it != header.end(); ++it)
      if (const std::string attribute = it.name(); attribute.starts_with("translucube:"))
        image.attributes[attribute] = text_attribute(header, attribute);
    image.width = window.max.x + 1;
    image.height = window.max.y + 1;
    planes.resize(image.channels.size() * std::size_t(image.width) * image.height);
    input.setFrameBuffer(frame_buffer(image, planes));
    input.readPixels(0, window.max.y);
  });
  const bool finite =
      std::ranges::all_of(planes, [](std::uint16_t half) { return (half & 0x7fffu) < 0x7c00u; });
  if (!finite) fail_image(file, "holds numbers that are not finite");
  return image;
}

}  // namespace translucube
