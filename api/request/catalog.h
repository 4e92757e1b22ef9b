#pragma once

// What a request may name, and the defaults and limits it is held to: config/service.json with the
// folders it points to, read once at the start.

#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/config/server_config.h"
#include "api/request/request.h"

namespace translucube::api {

struct ConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct NamedAbsorber {
  std::string description;
  SpectralAbsorber spectrum;
};

struct Limits {
  std::uint64_t body_bytes = 1 << 20;
  std::uint64_t pixels = 1 << 24;  ///< width x height
  std::uint32_t samples = 1 << 20;
  double seconds = 3600;
  double camera_samples = 1e12;   ///< pixels x samples of a render, times the images of a sweep
  std::uint32_t points = 20'000;  ///< of a sweep
};

struct Catalog {
  RenderRequest defaults;  ///< every default of a request
  Limits limits;
  ServerConfig server;
  std::map<std::string, NamedAbsorber> absorbers;
  std::map<std::string, std::filesystem::path> environments;
  std::filesystem::path display_config;             ///< OpenColorIO config
  std::vector<std::filesystem::path> file_folders;  ///< from which requests may name files
  bool any_file = false;                            ///< the command line: any path
};

/// Reads service.json and the folders it names (relative to its own place).
/// Throws ConfigError, which says the file, the pointer and the reason.
Catalog load_catalog(const std::filesystem::path& service_json);

/// For what was accepted before: it stays legal, whatever the limits are now.
Catalog without_limits(Catalog catalog);

}  // namespace translucube::api
