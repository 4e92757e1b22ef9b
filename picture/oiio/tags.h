#pragma once

#include <span>

#include "picture/stored_picture.h"

namespace translucube {

// What OpenImageIO does not tell of a file. Each throws ImageError for what is not honoured.

/// The transfer curve and primaries of a PNG: cICP before sRGB before gAMA and cHRM, and sRGB where
/// there is none (W3C, PNG 3rd edition, 4.3). An ICC profile comes before all but cICP.
void read_png_tags(std::span<const char> bytes, StoredPicture& stored);

/// Refuses JPEGs of four inks and of Adobe RGB without a profile.
void check_jpeg_tags(std::span<const char> bytes);

/// Refuses TIFFs with several pages and with what their first one says of colours outside RGB, grey
/// and palettes: transfer functions, primaries other than Rec.709's.
void check_tiff_tags(std::span<const char> bytes);

}  // namespace translucube
