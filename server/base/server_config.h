#pragma once

// The `server` section of config/service.json; docs/configuration.md says what each key is for.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/base/log.h"

namespace translucube::api {
class ConfigFile;
}

namespace translucube::server {

struct ServerConfig {
  std::string host = "127.0.0.1";
  int port = 8080;                    ///< 0: any free one
  std::filesystem::path data_folder;  ///< store and artifacts
  int workers = 1;                    ///< renders traced at once
  int threads_per_worker = 0;         ///< 0: all cores

  std::optional<std::filesystem::path> tokens_file;  ///< none: no tokens, loopback only
  std::vector<std::string> hosts;    ///< host[:port] that requests may name, lower case
  std::vector<std::string> origins;  ///< scheme://host[:port] of pages that may post, lower case

  int http_threads = 16;      ///< for requests that are answered at once
  int event_streams = 64;     ///< at once, a thread each
  int waiting_requests = 32;  ///< at once, of `Prefer: wait` and `?wait=`, a thread each
  int uploads = 4;            ///< that come or are read at once, a thread each
  int transfers = 32;         ///< clients slower than their upload or download, a thread each
  int connections = 512;      ///< open at once; those between requests hold no thread
  int header_timeout_s = 10;
  int idle_timeout_s = 60;
  int transfer_timeout_s = 20;
  int retry_ms =
      500;          ///< until what the world set back is tried again, at first; no key of the file
  int drain_s = 5;  ///< for passes under way, once the service is told to end

  std::uint64_t queue_length = 20'000;  ///< renders and images of sweeps
  int open_pictures = 256;          ///< files held open for those who ask again; no key of the file
  double interactive_seconds = 10;  ///< a render that is traced for longer waits with the sweeps
  std::uint64_t artifact_bytes = std::uint64_t{20} << 30;  ///< of finished pictures on the disk

  std::uint64_t upload_quota_bytes = std::uint64_t{4} << 30;  ///< of all uploads on the disk

  int keep_days = 365;  ///< renders and sweeps that have ended, their pictures, unused uploads

  std::uint64_t memory_bytes = 0;  ///< of renders; 0: three quarters of what there is
  std::uint64_t explorable_memory_bytes = std::uint64_t{256} << 20;  ///< of films kept in memory

  LogFormat log_format = LogFormat::logfmt;
};

/// Reads the section, over the defaults above. Its faults are the file's: whoever reads the last
/// section refuses them.
ServerConfig read_server_config(api::ConfigFile& file);

}  // namespace translucube::server
