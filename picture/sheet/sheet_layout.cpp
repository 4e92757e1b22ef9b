#include "picture/sheet/sheet_layout.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "picture/sheet/sheet_plan.h"

namespace translucube {

namespace {

using namespace sheet;

constexpr int min_cell = 32;

enum class Align { start, center, end };

/// Adds the text, shortened to the length of `room` and placed along it as `align` says, across it
/// in the middle.
void add_text(SheetLayout& layout, const Font& font, std::string_view text, int size,
              const Box& room, Align align, bool upright = false) {
  const int length = upright ? room.height : room.width;
  const std::string fitting = font.shorten(text, size, length);
  if (fitting.empty()) return;
  const int width = font.width(fitting, size), height = font.line_height(size);
  const int slack = length - width;
  const int along = align == Align::start ? 0 : align == Align::center ? slack / 2 : slack;
  const Box box =
      upright ? Box{room.x + (room.width - height) / 2, room.y + slack - along, height, width}
              : Box{room.x + along, room.y + (room.height - height) / 2, width, height};
  layout.texts.push_back({fitting, box, size, upright});
}

void add_panel_texts(SheetLayout& layout, const SheetSpec& spec, const Texts& texts,
                     const Panel& panel, const Font& font, std::size_t index) {
  const SheetLayout::Offset origin = layout.panel_offsets[index];
  const int grid_x = origin.x + panel.grid_x, grid_y = origin.y + panel.grid_y;
  const int space = panel.label_space();
  if (!texts.headings.empty())
    add_text(layout, font, texts.headings[index], panel.heading,
             {grid_x, origin.y, panel.width - panel.grid_x, panel.heading_line}, Align::start);
  if (is_labelled(spec, columns)) {
    const int labels_y = grid_y - space / 2 - panel.column_labels;
    add_text(layout, font, spec.axes[columns].title, panel.text,
             {grid_x, labels_y - space / 2 - panel.line, panel.column_title, panel.line},
             Align::center);
    for (int i = 0; i < count(spec, columns); ++i)
      add_text(layout, font, spec.axes[columns].labels[i], panel.text,
               {grid_x + i * panel.column_pitch, labels_y, panel.cell_width, panel.column_labels},
               panel.upright_columns ? Align::start : Align::center, panel.upright_columns);
  }
  if (is_labelled(spec, rows)) {
    add_text(layout, font, spec.axes[rows].title, panel.text,
             {origin.x, grid_y, panel.line, panel.row_title}, Align::center, true);
    for (int i = 0; i < count(spec, rows); ++i)
      add_text(layout, font, spec.axes[rows].labels[i], panel.text,
               {grid_x - space - panel.row_labels, grid_y + i * panel.row_pitch, panel.row_labels,
                panel.cell_height},
               Align::end);
  }
}

SheetLayout lay_out(const SheetSpec& spec, const Texts& texts, const Panel& panel,
                    const Arrangement& arrangement, const Font& font) {
  SheetLayout layout;
  layout.width = static_cast<int>(arrangement.width);
  layout.height = static_cast<int>(arrangement.height);
  layout.picture_width = spec.picture_width;
  layout.picture_height = spec.picture_height;
  layout.thumbnail_width = panel.thumbnail_width;
  layout.thumbnail_height = panel.thumbnail_height;
  for (int axis = 0; axis < 4; ++axis) layout.counts[axis] = count(spec, axis);
  layout.text_size = panel.text;
  layout.cell_in_panel = {panel.grid_x, panel.grid_y, panel.cell_width, panel.cell_height};
  layout.column_pitch = panel.column_pitch;
  layout.row_pitch = panel.row_pitch;

  const int margin = panel.margin();
  int y = margin;
  for (const auto& facts : texts.title_lines(panel.heading, layout.width - 2 * margin)) {
    std::string line;
    for (const std::size_t i : facts)
      line += std::string(line.empty() ? "" : separator) + texts.facts[i];
    add_text(layout, font, line, panel.heading,
             {margin, y, layout.width - 2 * margin, panel.heading_line}, Align::start);
    y += panel.heading_line;
  }

  int place = 0;
  for (int g = 0; g < count(spec, groups); ++g) {
    if (groups_start_rows(spec))
      place = (place + arrangement.per_row - 1) / arrangement.per_row * arrangement.per_row;
    for (int p = 0; p < count(spec, panels); ++p, ++place) {
      layout.panel_offsets.push_back(
          {margin + place % arrangement.per_row * (panel.width + panel.gutter()),
           margin + arrangement.title_height +
               place / arrangement.per_row * (panel.height + panel.gutter())});
      add_panel_texts(layout, spec, texts, panel, font, layout.panel_offsets.size() - 1);
    }
  }
  return layout;
}

[[noreturn]] void refuse_size(const SheetSpec& spec) {
  std::string counts;
  for (const SheetAxis& axis : spec.axes)
    counts += (counts.empty() ? "" : " x ") + std::to_string(axis.labels.size());
  throw SheetError("a contact sheet of " + counts +
                   " cells would be larger than 16384 x 16384 or " +
                   std::to_string(spec.max_pixels) + " pixels even with cells of 32 pixels");
}

/// Throws std::invalid_argument, and SheetError where not even the texts have room: what passes is
/// small enough to try.
void check(const SheetSpec& spec) {
  if (spec.picture_width < 1 || spec.picture_height < 1 || spec.cell_size < 1 ||
      spec.max_pixels < 1)
    throw std::invalid_argument("the sizes of a contact sheet must be positive");
  constexpr std::int64_t least_side = 10;  // of a cell, pixels: the smallest text
  const std::int64_t most_cells =
      std::min(spec.max_pixels, max_side * max_side) / (least_side * least_side);
  std::int64_t cells = 1;
  for (const SheetAxis& axis : spec.axes) {
    if (axis.labels.empty())
      throw std::invalid_argument("an axis of a contact sheet has no values: \"" + axis.title +
                                  "\"");
    if (std::ssize(axis.labels) > most_cells / cells) refuse_size(spec);
    cells *= std::ssize(axis.labels);
  }
  if (std::max(count(spec, columns), count(spec, rows)) > max_side / least_side) refuse_size(spec);
}

}  // namespace

Box SheetLayout::cell(const SheetCell& cell) const {
  for (std::size_t axis = 0; axis < 4; ++axis)
    if (cell[axis] < 0 || cell[axis] >= counts[axis])
      throw std::out_of_range("a contact sheet has no such cell");
  const Offset panel = panel_offsets[cell[groups] * counts[panels] + cell[panels]];
  Box box = cell_in_panel;
  box.x += panel.x + cell[columns] * column_pitch;
  box.y += panel.y + cell[rows] * row_pitch;
  return box;
}

Box SheetLayout::thumbnail(const SheetCell& at) const {
  const Box box = cell(at);
  return {box.x + (box.width - thumbnail_width) / 2, box.y + (box.height - thumbnail_height) / 2,
          thumbnail_width, thumbnail_height};
}

SheetLayout lay_out_sheet(const SheetSpec& spec, const Font& font) {
  check(spec);
  const Texts texts(spec, font);
  const int longer = std::max(spec.picture_width, spec.picture_height);
  int cell_size = static_cast<int>(
      std::min<std::int64_t>({std::max(spec.cell_size, min_cell), longer, max_side}));
  for (; cell_size >= std::min(longer, min_cell); --cell_size) {
    const Panel panel(spec, texts, font, cell_size);
    if (const auto arrangement = best_arrangement(spec, texts, panel))
      return lay_out(spec, texts, panel, *arrangement, font);
  }
  refuse_size(spec);
}

}  // namespace translucube
