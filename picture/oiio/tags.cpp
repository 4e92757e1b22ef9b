#include "picture/oiio/tags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "picture/image_io.h"

namespace translucube {
namespace {

using Kind = TransferCurve::Kind;

/// Numbers of either byte order at places that may not be there.
class Words {
 public:
  Words(std::span<const char> bytes, bool big) : bytes_(bytes), big_(big) {}

  std::optional<std::uint32_t> get(std::uint64_t at, std::size_t size) const {
    if (size > bytes_.size() || at > bytes_.size() - size) return {};
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const auto byte = static_cast<unsigned char>(bytes_[at + (big_ ? i : size - 1 - i)]);
      value = value << 8 | byte;
    }
    return value;
  }
  std::uint32_t want(std::uint64_t at, std::size_t size) const {
    if (const auto value = get(at, size)) return *value;
    throw ImageError("cut off");
  }

 private:
  std::span<const char> bytes_;
  bool big_;
};

/// Code points of ITU-T H.273: tables 2 and 3.
void read_cicp(std::uint32_t primaries, std::uint32_t transfer, std::uint32_t matrix,
               std::uint32_t full_range, StoredPicture& stored) {
  constexpr std::array<double, 2> d65{.3127, .3290};
  if (matrix != 0 || full_range != 1) throw ImageError("its cICP names no R, G, B of full range");
  switch (primaries) {
    case 1:
      break;
    case 9:
      stored.chromaticities = {{.708, .292}, {.170, .797}, {.131, .046}, d65};
      break;
    case 12:
      stored.chromaticities = {{.680, .320}, {.265, .690}, {.150, .060}, d65};
      break;
    default:
      throw ImageError("its cICP primaries " + std::to_string(primaries) + " are not read");
  }
  switch (transfer) {
    case 1:
    case 6:
    case 14:
    case 15:
      stored.transfer.kind = Kind::bt709;
      break;
    case 4:
      stored.transfer = {Kind::gamma, 2.2};
      break;
    case 5:
      stored.transfer = {Kind::gamma, 2.8};
      break;
    case 8:
      stored.transfer.kind = Kind::linear;
      break;
    case 13:
      stored.transfer.kind = Kind::srgb;
      break;
    default:
      throw ImageError("its cICP transfer " + std::to_string(transfer) +
                       " (16: PQ, 18: HLG) is not read");
  }
}

}  // namespace

void read_png_tags(std::span<const char> bytes, StoredPicture& stored) {
  const Words words(bytes, true);
  std::map<std::string_view, std::uint64_t> chunks;  // of each name the first one's data
  for (std::uint64_t at = 8;;) {
    const auto length = words.get(at, 4);
    if (!length || at + 8 > bytes.size()) break;
    const std::string_view name(bytes.data() + at + 4, 4);
    if (name == "IDAT") break;  // what says something of colours stands before it
    chunks.try_emplace(name, at + 8);
    at += 12 + std::uint64_t{*length};
  }
  const auto find = [&](std::string_view name) {
    const auto found = chunks.find(name);
    return found == chunks.end() ? std::optional<std::uint64_t>() : found->second;
  };
  stored.transfer.kind = Kind::srgb;
  if (const auto at = find("cICP")) {
    stored.icc_profile.clear();
    return read_cicp(words.want(*at, 1), words.want(*at + 1, 1), words.want(*at + 2, 1),
                     words.want(*at + 3, 1), stored);
  }
  if (!stored.icc_profile.empty() || find("sRGB")) return;
  if (const auto at = find("gAMA")) {
    const std::uint32_t value = words.want(*at, 4);
    if (value == 0) throw ImageError("its gAMA is 0");
    stored.transfer = {Kind::gamma, 100'000.0 / value};
    if (value == 100'000) stored.transfer = {};
  }
  if (const auto at = find("cHRM")) {
    std::array<double, 8> xy{};
    for (std::size_t i = 0; i < xy.size(); ++i) xy[i] = words.want(*at + 4 * i, 4) / 1e5;
    stored.chromaticities =
        Chromaticities{{xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]}, {xy[0], xy[1]}};
  }
}

void check_jpeg_tags(std::span<const char> bytes) {
  const Words words(bytes, true);
  for (std::uint64_t at = 2;;) {
    const auto marker = words.get(at, 2);
    if (!marker || *marker < 0xff01) return;  // the codec tells what is wrong
    if (*marker == 0xffda || *marker == 0xffd9) return;
    if (*marker == 0xffff) {  // fill bytes
      ++at;
      continue;
    }
    const std::uint32_t length = words.want(at + 2, 2), code = *marker & 0xff;
    const bool frame = code >= 0xc0 && code <= 0xcf && code != 0xc4 && code != 0xc8 && code != 0xcc;
    if (frame && words.want(at + 9, 1) == 4) throw ImageError("holds four inks (CMYK), not light");
    if (length < 2) return;
    at += 2 + std::uint64_t{length};
  }
}

void check_tiff_tags(std::span<const char> bytes) {
  const std::string_view start(bytes.data(), std::min<std::size_t>(bytes.size(), 4));
  const bool big = start.starts_with("MM");
  const Words words(bytes, big);
  if (words.want(2, 2) != 42) throw ImageError("a BigTIFF, which is not read");
  const std::uint32_t directory = words.want(4, 4), count = words.want(directory, 2);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t entry = std::uint64_t{directory} + 2 + std::uint64_t{12} * i;
    const std::uint32_t tag = words.want(entry, 2), type = words.want(entry + 2, 2);
    const std::uint32_t value = type == 3 ? words.want(entry + 8, 2) : words.want(entry + 8, 4);
    const auto differs = [&](std::span<const double> wanted) {
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        const double up = words.want(value + 8 * k, 4), down = words.want(value + 8 * k + 4, 4);
        if (!(std::fabs(up / down - wanted[k]) < 1e-3)) return true;
      }
      return false;
    };
    constexpr std::array<double, 2> white{.3127, .3290};
    constexpr std::array<double, 6> primaries{.64, .33, .30, .60, .15, .06};
    if (tag == 262 && value > 3)  // PhotometricInterpretation
      throw ImageError("its photometric interpretation " + std::to_string(value) +
                       " is neither grey, RGB nor a palette");
    if (tag == 301) throw ImageError("its TransferFunction is not read");
    if (tag == 318 && differs(white)) throw ImageError("its WhitePoint is not that of D65");
    if (tag == 319 && differs(primaries))
      throw ImageError("its PrimaryChromaticities are not those of Rec.709");
  }
  if (const auto next = words.get(std::uint64_t{directory} + 2 + std::uint64_t{12} * count, 4);
      next && *next != 0)
    throw ImageError("holds several pages");
}

}  // namespace translucube
