#include "picture/exr/stored_exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <cstring>
#include <stdexcept>

#include "picture/exr/file.h"

namespace translucube {
namespace {

/// Bytes in memory, as OpenEXR reads a file.
class Bytes final : public Imf::IStream {
 public:
  explicit Bytes(std::span<const char> bytes) : IStream("picture"), bytes_(bytes) {}

  bool isMemoryMapped() const override { return false; }
  bool read(char out[], int count) override {
    if (count < 0 || std::uint64_t(count) > bytes_.size() - at_)
      throw std::runtime_error("cut off");
    std::memcpy(out, bytes_.data() + at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::uint64_t>(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("cut off");
    at_ = position;
  }

 private:
  std::span<const char> bytes_;
  std::uint64_t at_ = 0;
};

bool has_light(const Imf::Header& header) {
  const Imf::ChannelList& channels = header.channels();
  const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
  return (has("R") && has("G") && has("B")) || (has("r") && has("g") && has("b")) || has("Y");
}

/// The part to read: of several the only one with light.
int lit_part(const Imf::MultiPartInputFile& file) {
  if (file.parts() == 1) return 0;
  int lit = -1;
  for (int part = 0; part < file.parts(); ++part) {
    if (!has_light(file.header(part))) continue;
    if (lit >= 0)
      throw ImageError("holds several pictures (parts " + std::to_string(lit) + " and " +
                       std::to_string(part) + ")");
    lit = part;
  }
  if (lit < 0) throw ImageError("none of its parts holds R, G and B or Y");
  return lit;
}

void check_kind(const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type()))
    throw ImageError("a deep or volume image, not a flat one");
  if (header.hasView() && header.view() == "right")
    throw ImageError("the right view of a stereo pair");
  if (Imf::hasEnvmap(header) && Imf::envmap(header) != Imf::ENVMAP_LATLONG)
    throw ImageError("a cube map (envmap), not a latitude-longitude map");
  const Imath::Box2i &data = header.dataWindow(), &display = header.displayWindow();
  check_size({}, std::int64_t{data.max.x} - data.min.x + 1,
             std::int64_t{data.max.y} - data.min.y + 1);
  if (data != display)
    throw ImageError("its data window is not its display window: a map has to be whole");
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      throw ImageError("has subsampled channels");
}

/// What its attributes say of colours.
void read_colors(const Imf::Header& header, StoredPicture& stored) {
  const auto* aces = header.findTypedAttribute<Imf::IntAttribute>("acesImageContainerFlag");
  if (Imf::hasChromaticities(header)) {
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    stored.chromaticities = Chromaticities{
        {c.red.x, c.red.y}, {c.green.x, c.green.y}, {c.blue.x, c.blue.y}, {c.white.x, c.white.y}};
  } else if (aces != nullptr && aces->value() == 1) {  // AP0 (SMPTE ST 2065-4)
    stored.chromaticities =
        Chromaticities{{.7347, .2653}, {.0, 1.0}, {.0001, -.0770}, {.32168, .33767}};
  }
  // Our own files may hold what a display shows.
  read_own_colorspace(text_attribute(header, colorspace_attribute), stored);
}

StoredPicture read_part(Imf::InputPart& part, std::size_t bytes) {
  const Imf::Header& header = part.header();
  check_kind(header);
  StoredPicture stored;
  read_colors(header, stored);
  const Imath::Box2i& window = header.dataWindow();
  stored.width = window.max.x - window.min.x + 1;
  stored.height = window.max.y - window.min.y + 1;
  check_not_cut_off(stored.width, stored.height, bytes);
  std::vector<std::string> light;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    stored.channels.emplace_back(it.name());
    const bool is_light = std::strlen(it.name()) == 1 && std::strchr("RGBYArgbya", *it.name());
    if (is_light && it.channel().type == Imf::UINT)
      throw ImageError("its channels are integers, not light");
    if (is_light) light.emplace_back(it.name());
  }
  // Nothing but light is taken; the others are told by name where there is none.
  const Imf::ChannelList& all = header.channels();
  const bool chroma = all.findChannel("RY") != nullptr || all.findChannel("BY") != nullptr;
  if (!has_light(header) || chroma) return stored;
  stored.channels = light;
  stored.samples.resize(stored.pixels() * light.size());
  Imf::FrameBuffer pixels;
  const std::size_t step = light.size() * sizeof(float);
  for (std::size_t c = 0; c < light.size(); ++c)
    pixels.insert(light[c], Imf::Slice::Make(Imf::FLOAT, stored.samples.data() + c, window, step,
                                             step * stored.width));
  part.setFrameBuffer(pixels);
  part.readPixels(window.min.y, window.max.y);
  return stored;
}

}  // namespace

StoredPicture read_stored_exr(std::span<const char> bytes) {
  try {
    Bytes stream(bytes);
    Imf::MultiPartInputFile file(stream, 0);
    for (int i = 0; i < file.parts(); ++i)
      if (file.header(i).hasType() && Imf::isDeepData(file.header(i).type()) && file.parts() == 1)
        throw ImageError("a deep or volume image, not a flat one");
    Imf::InputPart part(file, lit_part(file));
    return read_part(part, bytes.size());
  } catch (const ImageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw ImageError(std::string("not a readable image (") + error.what() + ")");
  }
}

}  // namespace translucube
