#pragma once

#include <filesystem>

namespace translucube {

/// A file that belongs to this program: beside it where it was built, in ../lib/translucube where
/// it is installed.
inline std::filesystem::path companion(const char* name) {
  std::error_code error;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  const auto installed = folder / "../lib/translucube" / name;
  return std::filesystem::exists(installed, error) ? installed : folder / name;
}

}  // namespace translucube
