#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "picture/sheet/text.h"

namespace translucube {

struct SheetError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Pixels of a sheet, from its left top corner.
struct Box {
  int x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const Box&, const Box&) = default;
};

struct SheetAxis {
  std::string title;                ///< "roughness r"; may be empty where the labels say it all
  std::vector<std::string> labels;  ///< one for each value, at least one
};

/// What a contact sheet shows: the pictures of a sweep over up to four axes.
struct SheetSpec {
  std::string title;  ///< may be empty; axes of one value are told behind it
  /// Columns, rows, panels and groups of panels: absorption, roughness, scattering, absorber. An
  /// axis that the sweep lacks has one empty label.
  std::array<SheetAxis, 4> axes;
  int picture_width = 0, picture_height = 0;        ///< of every picture, pixels
  int cell_size = 256;                              ///< wanted for the longer side, pixels
  std::int64_t max_pixels = std::int64_t{1} << 26;  ///< of the sheet, 12 bytes each
};

/// The place of a picture: its index on each axis of the spec.
using SheetCell = std::array<int, 4>;

/// A line of text as it is drawn, already so short that it fits.
struct SheetText {
  std::string text;
  Box box;               ///< what the text's mask fills
  int size = 0;          ///< pixels an em
  bool upright = false;  ///< turned by 90 degrees to read from the bottom up
};

/// Where everything lies. No two cells or texts overlap.
struct SheetLayout {
  int width = 0, height = 0;                      ///< of the sheet
  int picture_width = 0, picture_height = 0;      ///< as in the spec
  int thumbnail_width = 0, thumbnail_height = 0;  ///< of the pictures on the sheet
  std::array<int, 4> counts{};                    ///< values of each axis
  int text_size = 0;                              ///< of labels and states, 10 to 20 pixels an em
  Box cell_in_panel;                              ///< the first one, from its panel's corner
  int column_pitch = 0, row_pitch = 0;            ///< between cells of a panel
  struct Offset {
    int x = 0, y = 0;
  };
  std::vector<Offset> panel_offsets;  ///< of the panels, group after group
  std::vector<SheetText> texts;

  /// Holds a thumbnail, or the state of one that is missing. Throws std::out_of_range.
  Box cell(const SheetCell& cell) const;
  /// The place of the thumbnail, in the middle of the cell: smaller than it only for tiny or very
  /// long pictures.
  Box thumbnail(const SheetCell& cell) const;
};

/// The cells get as large as wanted, but never larger than the pictures, and shrink to no less than
/// 32 pixels so that the sheet stays within 16384 x 16384 and `max_pixels`. Panels wrap to make the
/// sheet a landscape; where there are several groups of several panels, each group starts a row.
/// Throws SheetError for a sheet that cannot be that small, std::invalid_argument for an axis
/// without values and for sizes that are not positive.
SheetLayout lay_out_sheet(const SheetSpec& spec, const Font& font);

}  // namespace translucube
