#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/answer/listings.h"
#include "api/base/result.h"
#include "server/base/places.h"
#include "server/base/server_config.h"
#include "server/store/job_store.h"
#include "server/store/upload_store.h"

namespace translucube::server {

/// Meshes and environments that clients send: received within bounds, read once in the sandbox,
/// kept by their bytes. Safe to share by threads. The config and the stores outlive it.
///
/// What is there stays. Only where an upload finds no room do others go: those that nobody has sent
/// or named for `keep_days` and that no render or sweep needs which has not ended, the one that was
/// unused longest first.
class Uploads {
 public:
  Uploads(const ServerConfig& config, std::uint64_t most_bytes, JobStore& jobs,
          UploadStore& uploads);

  /// Where an upload may go as it comes; it has its place until the file is destroyed. `length`: of
  /// the body, where that is known.
  api::Result<std::shared_ptr<ReceivedFile>> receive(std::optional<std::uint64_t> length);

  struct Kept {
    api::UploadReport report;
    bool created = false;  ///< false: it was there
  };
  /// What came, under the name that a client gave it. Takes as long as to parse it.
  api::Result<Kept> keep(api::UploadKind kind, const std::string& sha256, ReceivedFile& file);

  api::Result<std::vector<api::UploadReport>> list(api::UploadKind kind) const;

 private:
  void make_room(std::uint64_t bytes);
  bool is_needed(const std::string& sha256) const;

  const std::uint64_t most_bytes_;
  const std::int64_t keep_ms_;
  JobStore& jobs_;
  UploadStore& uploads_;
  Places places_;
};

}  // namespace translucube::server
