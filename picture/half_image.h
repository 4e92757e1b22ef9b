#pragma once

// Files of half floats in many channels, for what is no picture to look at.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "picture/image_io.h"

namespace translucube {

struct HalfImage {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< in alphabetical order of layers, R, G, B in each
  std::map<std::string, std::string> attributes;
};

/// Writes planes (channels x height x width, IEEE 754 binary16) as compressed EXR. Throws
/// ImageError; an incomplete file may stay behind: write to a temporary name.
void write_half_image(const std::filesystem::path& file, const HalfImage& image,
                      const std::vector<std::uint16_t>& planes);
/// Reads such a file; the attributes are those named "translucube:...". Throws ImageError, also for
/// an EXR that is not of half floats or holds infinities or NaNs.
HalfImage read_half_image(const std::filesystem::path& file, std::vector<std::uint16_t>& planes);

}  // namespace translucube
