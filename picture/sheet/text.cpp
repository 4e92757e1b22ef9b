// Text through FreeType: the only file that includes it.

#include "picture/sheet/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

namespace translucube {

namespace {

constexpr std::string_view ellipsis = "\u2026";
constexpr char32_t replacement = 0xFFFD;
// A glyph's ink may reach beyond its advance and, hinted, beyond the line: by at most so many
// pixels.
constexpr int overhang = 1;

/// Takes the first code point off; U+FFFD, and one byte off, where there is none.
char32_t next_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t length = lead < 0x80           ? 1
                             : (lead >> 5) == 0x06 ? 2
                             : (lead >> 4) == 0x0E ? 3
                             : (lead >> 3) == 0x1E ? 4
                                                   : 0;
  char32_t code = length == 1 ? lead : lead & (0x7Fu >> length);
  bool valid = length > 0 && length <= text.size();
  for (std::size_t i = 1; valid && i < length; ++i) {
    valid = (byte(i) >> 6) == 0x02;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  text.remove_prefix(valid ? length : 1);
  return valid ? code : replacement;
}

}  // namespace

struct Font::Impl {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  ~Impl() {
    if (face) FT_Done_Face(face);
    if (library) FT_Done_FreeType(library);
  }

  double units_per_em() const { return face->units_per_EM; }

  struct Glyph {
    FT_UInt index;
    double x;  ///< of its origin, em
  };
  struct Line {
    std::vector<Glyph> glyphs;
    double width = 0;  ///< em
  };

  /// A line of glyphs, in font units, so that positions do not depend on the size.
  Line set(std::string_view text) const {
    Line line;
    while (!text.empty()) {
      const FT_UInt index = FT_Get_Char_Index(face, next_code_point(text));
      FT_Vector kerning{};
      if (!line.glyphs.empty())
        FT_Get_Kerning(face, line.glyphs.back().index, index, FT_KERNING_UNSCALED, &kerning);
      line.width += kerning.x / units_per_em();
      line.glyphs.push_back({index, line.width});
      if (FT_Load_Glyph(face, index, FT_LOAD_NO_SCALE) == 0)
        line.width += face->glyph->metrics.horiAdvance / units_per_em();
    }
    return line;
  }

  void draw(const Glyph& glyph, int size, int baseline, TextMask& mask) const {
    // Light hinting aligns with the pixels in the vertical only: strokes are crisp, and advances
    // keep the proportions of the outlines.
    if (FT_Load_Glyph(face, glyph.index, FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP)) return;
    const double x = overhang + glyph.x * size, whole = std::floor(x);
    FT_Outline_Translate(&face->glyph->outline, std::lround(64 * (x - whole)), 0);
    if (FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL)) return;

    const FT_Bitmap& bitmap = face->glyph->bitmap;
    const int left = static_cast<int>(whole) + face->glyph->bitmap_left;
    const int top = baseline - face->glyph->bitmap_top;
    for (int row = 0; row < static_cast<int>(bitmap.rows); ++row)
      for (int column = 0; column < static_cast<int>(bitmap.width); ++column) {
        const int px = left + column, py = top + row;
        if (px < 0 || px >= mask.width || py < 0 || py >= mask.height) continue;
        float& coverage = mask.coverage[static_cast<std::size_t>(py) * mask.width + px];
        coverage = std::min(1.0f, coverage + bitmap.buffer[row * bitmap.pitch + column] / 255.0f);
      }
  }
};

Font::Font(const std::filesystem::path& file) : impl_(std::make_unique<Impl>()) {
  if (FT_Init_FreeType(&impl_->library)) throw TextError("FreeType cannot be started");
  if (FT_New_Face(impl_->library, file.c_str(), 0, &impl_->face))
    throw TextError("font " + file.string() + ": cannot be read, or no font");
  if (!FT_IS_SCALABLE(impl_->face))
    throw TextError("font " + file.string() + ": a bitmap font, not an outline font");
}

Font::~Font() = default;
Font::Font(Font&&) noexcept = default;

double Font::width_em(std::string_view text) const { return impl_->set(text).width; }

int Font::width(double width_em, int size) {
  return static_cast<int>(std::ceil(width_em * size)) + 2 * overhang;
}

int Font::width(std::string_view text, int size) const { return width(width_em(text), size); }

int Font::line_height(int size) const {
  const FT_Face face = impl_->face;
  return static_cast<int>(
             std::ceil((face->ascender - face->descender) * size / impl_->units_per_em())) +
         2 * overhang;
}

std::string Font::shorten(std::string_view text, int size, int max_width) const {
  if (width(text, size) <= max_width) return std::string(text);
  std::string longest;
  for (std::string_view rest = text; !rest.empty();) {
    std::string candidate(text.substr(0, text.size() - rest.size()));
    candidate += ellipsis;
    if (width(candidate, size) > max_width) break;
    longest = std::move(candidate);
    next_code_point(rest);
  }
  return longest;
}

TextMask Font::draw(std::string_view text, int size) const {
  const FT_Face face = impl_->face;
  if (FT_Set_Pixel_Sizes(face, 0, size)) throw TextError("the font has no size of its outlines");
  const Impl::Line line = impl_->set(text);
  TextMask mask{width(text, size), line_height(size), {}};
  mask.coverage.resize(static_cast<std::size_t>(mask.width) * mask.height);
  const int baseline =
      overhang + static_cast<int>(std::lround(face->ascender * size / impl_->units_per_em()));
  for (const Impl::Glyph& glyph : line.glyphs) impl_->draw(glyph, size, baseline, mask);
  return mask;
}

Font find_font(std::span<const std::filesystem::path> files) {
  std::string list;
  for (const std::filesystem::path& file : files) {
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return Font(file);
    list += (list.empty() ? "" : ", ") + file.string();
  }
  throw TextError("no font for labels: none of the files exists (" + list +
                  "); install fonts-dejavu-core, or name one by CMake's TRANSLUCUBE_FONTS");
}

Font find_font() {
  std::vector<std::filesystem::path> files;
  std::istringstream list(TRANSLUCUBE_FONTS);
  for (std::string file; std::getline(list, file, ':');) files.emplace_back(file);
  return find_font(files);
}

std::vector<std::string> number_labels(std::span<const double> values) {
  const auto text = [](double value, int digits) {
    char buffer[32];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits);
    return std::string(buffer, end.ptr);
  };
  for (int digits = 4;; ++digits) {
    std::vector<std::string> labels;
    std::map<std::string, double> value_of;
    bool told_apart = true;
    for (const double value : values) {
      labels.push_back(text(value, digits));
      const auto [known, is_new] = value_of.try_emplace(labels.back(), value);
      told_apart = told_apart && known->second == value;
    }
    if (told_apart || digits == std::numeric_limits<double>::max_digits10) return labels;
  }
}

}  // namespace translucube
