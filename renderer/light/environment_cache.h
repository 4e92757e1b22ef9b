#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "renderer/base/recently_used.h"
#include "renderer/light/environment.h"

namespace translucube {

/// Image environments ready to look up, for a process that builds many scenes: reading one and
/// building its tables takes longer than tracing a first pass. Used by threads at once.
class EnvironmentCache {
 public:
  /// The environment of an image file, from memory if the file, as its size and time of change tell
  /// it, was asked for not long ago with the same rotation, scale and side. Throws ImageError.
  std::shared_ptr<const ImageEnvironment> get(const std::filesystem::path& file,
                                              double rotation_rad, double scale,
                                              EnvironmentSide side = EnvironmentSide::all);

 private:
  /// The most that is kept, in pixels (24 bytes each), the last one apart.
  static constexpr std::uint64_t most_pixels = std::uint64_t{1} << 23;

  struct Key {
    std::filesystem::path file;
    std::uintmax_t bytes;
    std::filesystem::file_time_type changed;
    double rotation_rad, scale;
    EnvironmentSide side;
    friend bool operator==(const Key&, const Key&) = default;
  };
  RecentlyUsed<Key, ImageEnvironment> environments_{most_pixels};
};

}  // namespace translucube
