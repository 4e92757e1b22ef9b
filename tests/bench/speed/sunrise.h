#pragma once

// The environment with a hard sun.

#include <array>
#include <filesystem>

#include "tests/bench/speed/figures.h"

namespace translucube::speed {

/// sunrise.exr: as asked for, or where it may lie; empty where it is not.
inline std::filesystem::path sunrise(const Run& run) {
  const std::filesystem::path root = TRANSLUCUBE_SOURCE_DIR;
  for (const auto& file : {run.sun, root / "config/environments/sunrise.exr",
                           root.parent_path() / "shared/environments/sunrise.exr"})
    if (std::filesystem::is_regular_file(file)) return file;
  return {};
}

}  // namespace translucube::speed
