#pragma once

// What a request may name, and the defaults and limits it is held to: config/service.json with the
// folders it points to, read once at the start.

#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/request.h"

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

/// The `server` section of config/service.json.
struct ServerConfig {
  std::string host = "127.0.0.1";
  int port = 8080;
  std::filesystem::path data_folder;  ///< store and artifacts
  int workers = 1;                    ///< renders traced at once
  int threads_per_worker = 0;         ///< 0: all cores
  int http_threads = 16;
  std::uint64_t artifact_bytes = std::uint64_t{20} << 30;  ///< of finished pictures on the disk
  std::uint64_t queue_length = 20'000;                     ///< renders and images of sweeps
  double interactive_seconds = 10;  ///< a render that is traced for longer waits with the sweeps
  int event_streams = 64;           ///< at once
  int waiting_requests = 32;        ///< at once, of `Prefer: wait` and `?wait=`
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

}  // namespace translucube::api
