#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "picture/color.h"
#include "picture/image.h"
#include "picture/sheet/sheet_layout.h"
#include "picture/sheet/text.h"

namespace translucube {

/// What the pixels of a sheet are: how its pictures become such, and its greys among them.
struct SheetLook {
  std::function<void(Image&)> encode;  ///< scene-linear Rec.709 to the sheet's values, in place
  float background, frame, ink;        ///< values of the sheet
};

/// Scene-linear Rec.709, for EXR: pictures as they are. ColorConfig::apply_colorspace leads the
/// finished sheet elsewhere.
SheetLook scene_linear_look();

/// Display values, for PNG, by ColorConfig::apply_display, whose errors ContactSheet::place throws.
/// The config must outlive the look.
SheetLook display_look(const ColorConfig& colors, std::string display, std::string view);

/// The labelled picture of a sweep, composed of pictures that come one by one, in any order: memory
/// is that of the sheet and one picture. At first every cell is an empty frame.
class ContactSheet {
 public:
  /// The font must outlive the sheet.
  ContactSheet(SheetLayout layout, const Font& font, SheetLook look);

  /// Puts the picture, scene-linear Rec.709, into the cell: reduced in linear light, never
  /// enlarged, then encoded. Throws std::out_of_range for a cell that the sheet has not, and
  /// std::invalid_argument for a picture of another size than the layout is for.
  void place(const SheetCell& cell, const Image& picture);

  /// Makes the cell an empty frame with the state in it: "queued", "failed". Throws
  /// std::out_of_range.
  void mark(const SheetCell& cell, std::string_view state);

  const Image& image() const { return image_; }  ///< the sheet as it is now

 private:
  float* pixel(int x, int y);
  void fill(const Box& box, float value);
  void write(const SheetText& text);

  SheetLayout layout_;
  const Font& font_;
  SheetLook look_;
  Image image_;
};

}  // namespace translucube
