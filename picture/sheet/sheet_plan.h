#pragma once

// The sizes of a contact sheet before its places: private to sheet_layout.cpp.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "picture/sheet/sheet_layout.h"

namespace translucube::sheet {

constexpr std::int64_t max_side = 16384;  ///< of a sheet, pixels
constexpr std::string_view separator = "  \u00b7  ";

// The axes of a spec.
constexpr int columns = 0, rows = 1, panels = 2, groups = 3;

inline int count(const SheetSpec& spec, int axis) {
  return static_cast<int>(spec.axes[axis].labels.size());
}
/// Axes of one value are told in the title instead.
inline bool is_labelled(const SheetSpec& spec, int axis) { return count(spec, axis) > 1; }

/// The texts of a spec and their widths in em, which do not depend on the size of the cells.
struct Texts {
  std::vector<std::string> facts;     ///< of the title: what holds for all pictures
  std::vector<double> fact_widths;    ///< each
  std::vector<std::string> headings;  ///< of the panels, group after group; none of a single panel
  double separator_width = 0;
  // The widest of each:
  double heading = 0, column_labels = 0, row_labels = 0, column_title = 0, row_title = 0;

  Texts(const SheetSpec& spec, const Font& font);

  /// The indices of the facts on each line of a title that may be so many pixels wide.
  std::vector<std::vector<std::size_t>> title_lines(int size, int width) const;
};

/// A panel for a cell size. From its left top corner: heading, then titles and labels above and to
/// the left of the grid of cells. All in pixels.
struct Panel {
  int text = 0, heading = 0;       ///< sizes of labels, and of headings and title, per em
  int line = 0, heading_line = 0;  ///< heights of these texts
  int thumbnail_width = 0, thumbnail_height = 0;
  int cell_width = 0, cell_height = 0;  ///< a line of text fits into either
  int column_pitch = 0, row_pitch = 0;
  bool upright_columns = false;           ///< labels that are too wide for their column
  int column_labels = 0, row_labels = 0;  ///< height and width
  int grid_x = 0, grid_y = 0;
  int column_title = 0, row_title = 0;  ///< lengths of their room, at least that of the grid
  int width = 0, height = 0;

  Panel(const SheetSpec& spec, const Texts& texts, const Font& font, int cell_size);

  int label_space() const { return text / 2; }    ///< between labels and what is next to them
  int gutter() const { return 2 * text; }         ///< between panels
  int margin() const { return text + text / 2; }  ///< around the sheet
};

/// How the panels wrap.
struct Arrangement {
  int per_row = 1, panel_rows = 1;
  int title_height = 0;                ///< with the space below it, pixels
  std::int64_t width = 0, height = 0;  ///< of the sheet, pixels

  Arrangement(const SheetSpec& spec, const Texts& texts, const Panel& panel, int panels_per_row);
};

/// Whether each group of panels starts a row.
inline bool groups_start_rows(const SheetSpec& spec) {
  return is_labelled(spec, panels) && is_labelled(spec, groups);
}

/// The one that looks best of those within the limits, if there is any.
std::optional<Arrangement> best_arrangement(const SheetSpec& spec, const Texts& texts,
                                            const Panel& panel);

}  // namespace translucube::sheet
