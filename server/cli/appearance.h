#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace translucube::server {

struct AppearanceOptions {
  std::string request;                          ///< a file, or "-" for standard input
  std::optional<std::filesystem::path> output;  ///< standard output where it is not given
  std::string config;
  int threads = 0;  ///< 0: all cores
};

/// Slab optics of a material as JSON. The exit status; messages go to standard error.
int run_appearance(const AppearanceOptions& options);

}  // namespace translucube::server
