#pragma once

// The environment with a hard sun.

#include <array>
#include <filesystem>

#include "tests/bench/speed/figures.h"
#include "tests/support/repository.h"

namespace translucube::speed {

/// sunrise.exr: as asked for, or where it may lie; empty where it is not.
inline std::filesystem::path sunrise(const Run& run) {
  for (const auto& file : {run.sun, in_repository("config/environments/sunrise.exr")})
    if (std::filesystem::is_regular_file(file)) return file;
  return {};
}

}  // namespace translucube::speed
