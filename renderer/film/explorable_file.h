#pragma once

// Explorable films as EXR files.

#include <filesystem>
#include <string>

#include "renderer/film/explorable.h"

namespace translucube {

/// Compressed multi-channel EXR of half floats: a layer of R, G and B for each bin; the lengths,
/// the scales, the unit and the canonical request in its header. Throw ImageError.
void write_explorable(const std::filesystem::path& file, const ExplorableFilm& film,
                      const std::string& canonical_request);
struct StoredExplorable {
  ExplorableFilm film;
  std::string request;
};
StoredExplorable read_explorable(const std::filesystem::path& file);

}  // namespace translucube
