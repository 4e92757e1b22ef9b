#pragma once

// What picture files of strangers hold. Each format's reader (exr/, oiio/, light/) tells it and
// decides nothing; light/decode.h decides for all of them. None of it opens a file: it runs in a
// process without rights (sandbox/).

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace translucube {

/// The formats that environments come in.
enum class LightFormat { exr, radiance, png, jpeg, tiff, unknown };

/// CIE 1931 x, y of red, green, blue and white.
struct Chromaticities {
  std::array<double, 2> red, green, blue, white;
};
inline constexpr Chromaticities rec709{{.64, .33}, {.30, .60}, {.15, .06}, {.3127, .3290}};

/// How stored numbers become light.
struct TransferCurve {
  enum class Kind { linear, srgb, bt709, gamma } kind = Kind::linear;
  double gamma = 1;  ///< of Kind::gamma: light = number^gamma
};

enum class AlphaKind { associated, unassociated };

/// What a file holds.
struct StoredPicture {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< their names, in the order of the samples
  std::vector<float> samples;         ///< height x width x channels, as stored (integers: 0 to 1)
  TransferCurve transfer;
  /// The primaries of R, G, B; nothing: those of Rec.709. X, Y, Z where `is_xyz`.
  std::optional<Chromaticities> chromaticities;
  bool is_xyz = false;
  std::vector<std::uint8_t> icc_profile;    ///< says more than transfer and chromaticities
  std::array<double, 3> exposure{1, 1, 1};  ///< what R, G and B of the light were multiplied by
  AlphaKind alpha = AlphaKind::associated;
  int orientation = 1;  ///< where row 0 and column 0 are, as EXIF 2.3 counts (1: top, left)

  std::size_t pixels() const { return std::size_t(width) * height; }
};

}  // namespace translucube
