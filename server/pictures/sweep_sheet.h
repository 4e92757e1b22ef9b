#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "api/request/sweep.h"
#include "picture/color.h"
#include "picture/sheet/contact_sheet.h"
#include "server/pictures/image_artifacts.h"

namespace translucube::server {

/// The contact sheet of a sweep: absorption along the columns, roughness along the rows, a panel
/// for each scattering and absorber.
class SweepSheet {
 public:
  /// The colours must outlive the sheet. `max_pixels` of the sheet, 12 bytes each. Throws
  /// SheetError where so many cells cannot be that small, and TextError where there is no font.
  SweepSheet(const api::Sweep& sweep, const ImageForm& form, const ColorConfig& colors,
             std::int64_t max_pixels = std::int64_t{1} << 24);

  /// `picture`: scene-linear Rec.709. Throws ColorError.
  void place(std::size_t point, const Image& picture);
  void mark(std::size_t point, std::string_view state);
  /// Throws ImageError.
  void write(const std::filesystem::path& file, const std::string& canonical_sweep) const;

 private:
  SheetCell cell(std::size_t point) const;

  api::Sweep sweep_;
  ImageForm form_;
  const ColorConfig& colors_;
  Font font_;
  ContactSheet sheet_;
};

}  // namespace translucube::server
