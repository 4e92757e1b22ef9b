#pragma once

// The only door to fonts; text.cpp is the only file that includes FreeType.

#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace translucube {

struct TextError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A line of text, drawn: how much of each pixel it covers.
struct TextMask {
  int width = 0, height = 0;
  std::vector<float> coverage;  ///< height x width, in [0, 1], row 0 at the top
};

/// An outline font. Text is UTF-8, one line, set with kerning; what is malformed becomes U+FFFD.
/// Lengths are in em or, for a size of so many pixels an em, in pixels. Not to be shared by
/// threads.
class Font {
 public:
  /// Throws TextError if the file is no outline font that FreeType reads.
  explicit Font(const std::filesystem::path& file);
  ~Font();
  Font(Font&&) noexcept;

  double width_em(std::string_view text) const;      ///< the same for all sizes
  static int width(double width_em, int size);       ///< of the mask of a text so wide
  int width(std::string_view text, int size) const;  ///< of the mask
  int line_height(int size) const;                   ///< of every mask

  /// The text or, where it is wider than `max_width` pixels, its longest beginning that fits with
  /// an ellipsis behind it; empty where not even the ellipsis fits.
  std::string shorten(std::string_view text, int size, int max_width) const;

  /// Anti-aliased, width(text, size) x line_height(size).
  TextMask draw(std::string_view text, int size) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The first of the files that exists. Throws TextError, which names them all, if none does.
Font find_font(std::span<const std::filesystem::path> files);
/// The first that exists of the fonts that CMake's TRANSLUCUBE_FONTS lists.
Font find_font();

/// A label for each value: the shortest text of the value rounded to four significant digits, or to
/// as many more as it takes to tell different values apart. 0.3 is "0.3", one third "0.3333".
std::vector<std::string> number_labels(std::span<const double> values);

}  // namespace translucube
