#include "picture/light/stored_hdr.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "picture/image_io_rules.h"

namespace translucube {
namespace {

class HdrReader {
 public:
  explicit HdrReader(std::span<const char> bytes) : rest_(bytes.data(), bytes.size()) {}

  StoredPicture read() {
    read_header();
    read_resolution();
    read_pixels();
    return std::move(stored_);
  }

 private:
  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    if (end == rest_.npos) throw ImageError("its header has no end");
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }

  static std::vector<double> numbers(std::string_view name, std::string_view text,
                                     std::size_t count) {
    std::vector<double> found;
    while (true) {
      const std::size_t begin = text.find_first_not_of(" \t");
      if (begin == text.npos) break;
      text.remove_prefix(begin);
      if (text.starts_with('+')) text.remove_prefix(1);
      double number = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      if (error != std::errc{} || !std::isfinite(number) || found.size() == count)
        throw ImageError("its " + std::string(name) + " is not understood");
      found.push_back(number);
      text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
    if (found.size() != count) throw ImageError("its " + std::string(name) + " is not understood");
    return found;
  }

  void read_header() {
    bool format = false;
    line();  // "#?RADIANCE" or the like
    for (std::string_view text; !(text = line()).empty();) {
      const std::size_t equals = text.find('=');
      if (text.starts_with('#') || equals == text.npos) continue;
      const std::string_view name = text.substr(0, equals), value = text.substr(equals + 1);
      if (name == "FORMAT") {
        const std::size_t begin = std::min(value.find_first_not_of(" \t"), value.size());
        const std::string_view kind =
            value.substr(begin, value.find_last_not_of(" \t") + 1 - begin);
        stored_.is_xyz = kind == "32-bit_rle_xyze";
        if (!stored_.is_xyz && kind != "32-bit_rle_rgbe")
          throw ImageError("its FORMAT is neither 32-bit_rle_rgbe nor 32-bit_rle_xyze");
        format = true;
      } else if (name == "EXPOSURE") {
        for (double& e : stored_.exposure) e *= numbers(name, value, 1)[0];
      } else if (name == "COLORCORR") {
        const auto by = numbers(name, value, 3);
        for (std::size_t c = 0; c < 3; ++c) stored_.exposure[c] *= by[c];
      } else if (name == "GAMMA") {
        stored_.transfer = {TransferCurve::Kind::gamma, numbers(name, value, 1)[0]};
      } else if (name == "PRIMARIES") {
        const auto xy = numbers(name, value, 8);
        stored_.chromaticities =
            Chromaticities{{xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]}};
      }
    }
    if (!format) throw ImageError("its header names no FORMAT");
    if (stored_.transfer.kind == TransferCurve::Kind::gamma && stored_.transfer.gamma == 1)
      stored_.transfer = {};
  }

  /// "-Y 512 +X 1024" and its seven relatives: the axis that changes slowly comes first.
  void read_resolution() {
    std::string_view text = line();
    struct Axis {
      char name, sign;
      int size;
    };
    const auto axis = [&] {
      Axis a{};
      if (text.starts_with(' ')) text.remove_prefix(1);
      if (text.size() < 4 || text[2] != ' ') throw ImageError("its resolution is not understood");
      a.sign = text[0];
      a.name = text[1];
      text.remove_prefix(3);
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), a.size);
      if (error != std::errc{} || (a.sign != '-' && a.sign != '+'))
        throw ImageError("its resolution is not understood");
      text.remove_prefix(static_cast<std::size_t>(end - text.data()));
      return a;
    };
    const Axis slow = axis(), fast = axis();
    const bool rows = slow.name == 'Y' && fast.name == 'X';
    if (!text.empty() || (!rows && !(slow.name == 'X' && fast.name == 'Y')))
      throw ImageError("its resolution is not understood");
    // Y counts upwards: "-Y" begins at the top.
    const bool from_top = (rows ? slow : fast).sign == '-';
    const bool from_left = (rows ? fast : slow).sign == '+';
    stored_.orientation = rows ? (from_top ? (from_left ? 1 : 2) : (from_left ? 4 : 3))
                               : (from_top ? (from_left ? 5 : 6) : (from_left ? 8 : 7));
    stored_.width = fast.size;
    stored_.height = slow.size;
    check_size({}, stored_.width, stored_.height);
  }

  void read_pixels() {
    stored_.channels = {"R", "G", "B"};
    // A run of the new form packs 127 pixels to 8 bytes, the old one any number of them, which no
    // picture needs.
    if (stored_.pixels() / 127 > rest_.size() + 1) throw ImageError("cut off");
    stored_.samples.resize(3 * stored_.pixels());
    std::vector<std::array<unsigned char, 4>> row(static_cast<std::size_t>(stored_.width));
    float* out = stored_.samples.data();
    for (int y = 0; y < stored_.height; ++y) {
      read_row(row);
      for (const auto& p : row) {
        const double unit = p[3] == 0 ? 0 : std::ldexp(1.0, p[3] - (128 + 8));
        for (std::size_t c = 0; c < 3; ++c) *out++ = static_cast<float>(p[c] * unit);
      }
    }
  }

  unsigned char byte() {
    if (rest_.empty()) throw ImageError("cut off");
    const auto value = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }

  using Row = std::vector<std::array<unsigned char, 4>>;

  void read_row(Row& row) {
    const auto is = [&](std::size_t i, int value) {
      return static_cast<unsigned char>(rest_[i]) == value;
    };
    if (rest_.size() < 4) throw ImageError("cut off");
    const bool packed = row.size() >= 8 && row.size() < 0x8000 && is(0, 2) && is(1, 2) &&
                        static_cast<unsigned char>(rest_[2]) < 128;
    if (!packed) return read_old_row(row);
    byte();
    byte();
    const std::size_t high = byte(), length = high << 8 | byte();
    if (length != row.size()) throw ImageError("a row of another length than the picture's");
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t x = 0; x < row.size();) {
        const std::size_t code = byte();
        const bool run = code > 128;
        const std::size_t count = run ? code - 128 : code;
        if (count == 0 || count > row.size() - x) throw ImageError("a run beyond the row's end");
        const unsigned char value = run ? byte() : 0;
        for (std::size_t i = 0; i < count; ++i) row[x++][c] = run ? value : byte();
      }
  }

  /// Four bytes a pixel; (1, 1, 1, n) repeats the one before n times, one after the other n, 256 n,
  /// ...
  void read_old_row(Row& row) {
    int shift = 0;
    for (std::size_t x = 0; x < row.size();) {
      std::array<unsigned char, 4> p{};
      for (unsigned char& b : p) b = byte();
      if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
        row[x++] = p;
        shift = 0;
        continue;
      }
      const std::size_t count = shift < 24 ? std::size_t{p[3]} << shift : row.size() + 1;
      if (x == 0 || count > row.size() - x) throw ImageError("a run beyond the row's end");
      for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
      shift += 8;
    }
  }

  std::string_view rest_;
  StoredPicture stored_;
};

}  // namespace

StoredPicture read_stored_hdr(std::span<const char> bytes) { return HdrReader(bytes).read(); }

}  // namespace translucube
