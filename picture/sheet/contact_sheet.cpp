#include "picture/sheet/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "picture/reduce.h"
#include "picture/srgb.h"

namespace translucube {

namespace {

constexpr float background_code = 0.25f, frame_code = 0.5f, ink_code = 0.92f;

}  // namespace

SheetLook scene_linear_look() {
  return {[](Image&) {}, srgb_to_linear(background_code), srgb_to_linear(frame_code),
          srgb_to_linear(ink_code)};
}

// The greys are code values of the display, not colours of the scene, so that a view's tone mapping
// does not touch them.
SheetLook display_look(const ColorConfig& colors, std::string display, std::string view) {
  return {[&colors, display = std::move(display), view = std::move(view)](Image& image) {
            colors.apply_display(image, display, view);
          },
          background_code, frame_code, ink_code};
}

ContactSheet::ContactSheet(SheetLayout layout, const Font& font, SheetLook look)
    : layout_(std::move(layout)),
      font_(font),
      look_(std::move(look)),
      image_(layout_.width, layout_.height) {
  std::fill(image_.pixels.begin(), image_.pixels.end(), look_.background);
  for (const SheetText& text : layout_.texts) write(text);
  const auto& counts = layout_.counts;
  for (int g = 0; g < counts[3]; ++g)
    for (int p = 0; p < counts[2]; ++p)
      for (int row = 0; row < counts[1]; ++row)
        for (int column = 0; column < counts[0]; ++column) mark({column, row, p, g}, "");
}

void ContactSheet::place(const SheetCell& cell, const Image& picture) {
  const Box box = layout_.thumbnail(cell);
  if (picture.width != layout_.picture_width || picture.height != layout_.picture_height)
    throw std::invalid_argument("a picture of another size than the contact sheet is for");
  Image thumbnail = reduce(picture, box.width, box.height);
  look_.encode(thumbnail);

  fill(layout_.cell(cell), look_.background);
  const std::ptrdiff_t row_size = std::ptrdiff_t{3} * box.width;
  for (int row = 0; row < box.height; ++row)
    std::copy_n(thumbnail.pixels.begin() + row * row_size, row_size, pixel(box.x, box.y + row));
}

void ContactSheet::mark(const SheetCell& cell, std::string_view state) {
  const Box box = layout_.cell(cell);
  fill(box, look_.frame);
  const int size = layout_.text_size, line = size / 8;
  fill({box.x + line, box.y + line, box.width - 2 * line, box.height - 2 * line}, look_.background);

  const int height = font_.line_height(size);
  const std::string text = font_.shorten(state, size, box.width - 2 * line);
  if (text.empty()) return;
  const int width = font_.width(text, size);
  write({text,
         {box.x + (box.width - width) / 2, box.y + (box.height - height) / 2, width, height},
         size});
}

float* ContactSheet::pixel(int x, int y) {
  return image_.pixels.data() + (static_cast<std::size_t>(y) * image_.width + x) * 3;
}

void ContactSheet::fill(const Box& box, float value) {
  for (int row = 0; row < box.height; ++row)
    std::fill_n(pixel(box.x, box.y + row), std::size_t{3} * box.width, value);
}

void ContactSheet::write(const SheetText& text) {
  const TextMask mask = font_.draw(text.text, text.size);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const float coverage = mask.coverage[static_cast<std::size_t>(y) * mask.width + x];
      float* const values = text.upright ? pixel(text.box.x + y, text.box.y + mask.width - 1 - x)
                                         : pixel(text.box.x + x, text.box.y + y);
      for (int c = 0; c < 3; ++c) values[c] += coverage * (look_.ink - values[c]);
    }
}

}  // namespace translucube
