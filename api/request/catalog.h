#pragma once

// What a request may name, and the defaults and limits it is held to: from config/service.json and
// the folders it points to, read once at the start.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/request/request.h"

namespace translucube::api {

class ConfigFile;

struct NamedAbsorber {
  std::string description;
  SpectralAbsorber spectrum;
};

struct Limits {
  std::uint64_t body_bytes = 1 << 20;
  std::uint64_t pixels = 1 << 24;  ///< width x height
  std::uint32_t samples = 1 << 20;
  double seconds = 3600;
  std::uint64_t upload_bytes = 256 << 20;  ///< of one
  double camera_samples = 1e12;   ///< pixels x samples of a render, times the images of a sweep
  std::uint32_t points = 20'000;  ///< of a sweep
};

struct Catalog {
  RenderRequest defaults;  ///< every default of a request
  Limits limits;
  std::map<std::string, NamedAbsorber> absorbers;
  std::map<std::string, std::filesystem::path> environments;
  std::filesystem::path display_config;             ///< OpenColorIO config
  std::vector<std::filesystem::path> file_folders;  ///< from which requests may name files
  std::optional<std::filesystem::path>
      uploads;               ///< their folder (upload.h); only a service has one
  bool any_file = false;     ///< the command line: any path
  bool knows_files = false;  ///< what is in the files that requests name was looked at before
};

/// Reads a catalog from service.json, all but its section `server`, and from the folders it names.
/// Throws ConfigError where this or a section that was read before has faults.
Catalog load_catalog(ConfigFile& service_json);
Catalog load_catalog(const std::filesystem::path& service_json);

/// The catalog for what was accepted before: it stays legal, whatever the limits are now, and what
/// is in its files is not looked at again.
Catalog without_limits(Catalog catalog);

}  // namespace translucube::api
