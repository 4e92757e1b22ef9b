#pragma once

// The only door to colour management; color.cpp is the only file that includes OpenColorIO.

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "picture/image.h"

namespace translucube {

struct ColorError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Display {
  std::string name;
  std::vector<std::string> views;  ///< the first one is the default
};

/// A loaded OpenColorIO config. `$OCIO`, where set, wins over the file. Safe to share by threads.
class ColorConfig {
 public:
  /// Throws ColorError if the config cannot be read or lacks the scene-linear spaces.
  explicit ColorConfig(const std::filesystem::path& config);
  ~ColorConfig();
  ColorConfig(ColorConfig&&) noexcept;

  const std::vector<Display>& displays() const;  ///< the first one is the default

  /// Scene-linear Rec.709 to display code values in [0, 1], in place. Throws ColorError for an
  /// unknown display or view.
  void apply_display(Image& image, const std::string& display, const std::string& view) const;

  /// Scene-linear Rec.709 to "lin_rec709", "ACEScg" or "XYZ" (CIE XYZ, D65), in place.
  void apply_colorspace(Image& image, const std::string& colorspace) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace translucube
