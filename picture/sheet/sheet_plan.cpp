#include "picture/sheet/sheet_plan.h"

#include <algorithm>
#include <cmath>

namespace translucube::sheet {

namespace {

// What a text may claim for itself, em; longer ones are shortened to it unless there is room
// anyway.
constexpr double widest_label = 10, widest_axis_title = 16, widest_heading = 24;

std::string named(const SheetAxis& axis, std::size_t value) {
  return axis.title.empty() || axis.labels[value].empty() ? axis.labels[value]
                                                          : axis.title + " = " + axis.labels[value];
}

std::vector<std::string> panel_headings(const SheetSpec& spec) {
  std::vector<std::string> headings;
  if (!is_labelled(spec, panels) && !is_labelled(spec, groups)) return headings;
  for (int g = 0; g < count(spec, groups); ++g)
    for (int p = 0; p < count(spec, panels); ++p) {
      std::string heading = is_labelled(spec, groups) ? named(spec.axes[groups], g) : "";
      if (groups_start_rows(spec)) heading += separator;
      if (is_labelled(spec, panels)) heading += named(spec.axes[panels], p);
      headings.push_back(std::move(heading));
    }
  return headings;
}

bool fits(const Arrangement& sheet, std::int64_t max_pixels) {
  return sheet.width <= max_side && sheet.height <= max_side &&
         sheet.width * sheet.height <= max_pixels;
}

/// 0 for a landscape of 3 : 2 with no empty places. Three panels are better in a row than in a
/// square with a hole, five are not.
double ugliness(const Arrangement& sheet, int panel_count) {
  const double holes = double(sheet.per_row) * sheet.panel_rows / panel_count - 1;
  return std::abs(std::log(double(sheet.width) / double(sheet.height) / 1.5)) + 3 * holes;
}

}  // namespace

Texts::Texts(const SheetSpec& spec, const Font& font) : headings(panel_headings(spec)) {
  facts.push_back(spec.title);
  for (const SheetAxis& axis : spec.axes)
    if (axis.labels.size() == 1) facts.push_back(named(axis, 0));
  std::erase(facts, "");
  for (const std::string& fact : facts) fact_widths.push_back(font.width_em(fact));
  separator_width = font.width_em(separator);

  const auto widest = [&](const std::vector<std::string>& lines) {
    double width = 0;
    for (const std::string& line : lines) width = std::max(width, font.width_em(line));
    return width;
  };
  heading = widest(headings);
  column_labels = widest(spec.axes[columns].labels);
  row_labels = widest(spec.axes[rows].labels);
  column_title = font.width_em(spec.axes[columns].title);
  row_title = font.width_em(spec.axes[rows].title);
}

std::vector<std::vector<std::size_t>> Texts::title_lines(int size, int width) const {
  std::vector<std::vector<std::size_t>> lines;
  double line_width = 0;
  for (std::size_t i = 0; i < facts.size(); ++i) {
    const double joined = line_width + separator_width + fact_widths[i];
    if (lines.empty() || Font::width(joined, size) > width) {
      lines.push_back({i});
      line_width = fact_widths[i];
    } else {
      lines.back().push_back(i);
      line_width = joined;
    }
  }
  return lines;
}

Panel::Panel(const SheetSpec& spec, const Texts& texts, const Font& font, int cell_size) {
  const double scale =
      std::min(1.0, double(cell_size) / std::max(spec.picture_width, spec.picture_height));
  text = static_cast<int>(std::clamp(std::lround(cell_size / 11.0), 10L, 20L));
  heading = static_cast<int>(std::lround(1.2 * text));
  line = font.line_height(text);
  heading_line = font.line_height(heading);
  thumbnail_width = std::max(1, static_cast<int>(std::lround(spec.picture_width * scale)));
  thumbnail_height = std::max(1, static_cast<int>(std::lround(spec.picture_height * scale)));
  cell_width = std::max(thumbnail_width, line);
  cell_height = std::max(thumbnail_height, line);
  const int gap = std::max(2, cell_size / 48);
  column_pitch = cell_width + gap;
  row_pitch = cell_height + gap;

  const auto room = [](double width_em, double most_em, int size) {
    return width_em > 0 ? Font::width(std::min(width_em, most_em), size) : 0;
  };
  const int grid_width = count(spec, columns) * column_pitch - gap;
  const int grid_height = count(spec, rows) * row_pitch - gap;
  column_title = grid_width;
  row_title = grid_height;
  if (!texts.headings.empty()) grid_y += heading_line + label_space();
  if (is_labelled(spec, columns)) {
    upright_columns = Font::width(texts.column_labels, text) > cell_width;
    column_labels = upright_columns ? room(texts.column_labels, widest_label, text) : line;
    grid_y += column_labels + label_space() / 2;
    if (texts.column_title > 0) grid_y += line + label_space() / 2;
    column_title = std::max(column_title, room(texts.column_title, widest_axis_title, text));
  }
  if (is_labelled(spec, rows)) {
    row_labels = room(texts.row_labels, widest_label, text);
    grid_x += row_labels + label_space();
    if (texts.row_title > 0) grid_x += line + label_space();
    row_title = std::max(row_title, room(texts.row_title, widest_axis_title, text));
  }
  width = grid_x + std::max(column_title, room(texts.heading, widest_heading, heading));
  height = grid_y + row_title;
}

Arrangement::Arrangement(const SheetSpec& spec, const Texts& texts, const Panel& panel,
                         int panels_per_row)
    : per_row(panels_per_row) {
  const auto rows_of = [&](int n) { return (n + per_row - 1) / per_row; };
  panel_rows = groups_start_rows(spec) ? count(spec, groups) * rows_of(count(spec, panels))
                                       : rows_of(count(spec, groups) * count(spec, panels));
  width = std::int64_t{per_row} * (panel.width + panel.gutter()) - panel.gutter();
  for (const double fact : texts.fact_widths)
    width =
        std::max<std::int64_t>(width, Font::width(std::min(fact, widest_heading), panel.heading));
  const int title_width = static_cast<int>(std::min(width, max_side));
  const int lines = static_cast<int>(texts.title_lines(panel.heading, title_width).size());
  title_height = lines == 0 ? 0 : lines * panel.heading_line + panel.text;
  height =
      std::int64_t{panel_rows} * (panel.height + panel.gutter()) - panel.gutter() + title_height;
  width += std::int64_t{2} * panel.margin();
  height += std::int64_t{2} * panel.margin();
}

std::optional<Arrangement> best_arrangement(const SheetSpec& spec, const Texts& texts,
                                            const Panel& panel) {
  const int panel_count = count(spec, panels) * count(spec, groups);
  const int most = groups_start_rows(spec) ? count(spec, panels) : panel_count;
  std::optional<Arrangement> best;
  for (int per_row = 1; per_row <= most && per_row <= max_side / panel.width; ++per_row) {
    const Arrangement tried(spec, texts, panel, per_row);
    if (fits(tried, spec.max_pixels) &&
        (!best || ugliness(tried, panel_count) < ugliness(*best, panel_count)))
      best = tried;
  }
  return best;
}

}  // namespace translucube::sheet
