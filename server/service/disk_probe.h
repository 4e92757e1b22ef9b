#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "server/store/artifact_store.h"
#include "server/store/data_folder.h"
#include "server/store/job_store.h"

namespace translucube::server {

/// Whether the disk takes what is written, and has room for what was accepted. Asked often, it
/// looks once a second. Safe to share by threads. The stores and the folder outlive it.
class DiskProbe {
 public:
  DiskProbe(JobStore& store, ArtifactStore& artifacts, const DataFolder& folder,
            std::uint64_t quota_bytes)
      : store_(store), artifacts_(artifacts), folder_(folder), quota_bytes_(quota_bytes) {}

  /// Why not; empty where it does.
  std::optional<std::string> failure();

 private:
  bool has_room() const;

  JobStore& store_;
  ArtifactStore& artifacts_;
  const DataFolder& folder_;
  const std::uint64_t quota_bytes_;
  std::mutex mutex_;
  std::optional<std::chrono::steady_clock::time_point> probed_at_;
  std::optional<std::string> failure_;
};

/// What the job with the largest pictures needs beside them while it is worked on: its film, the
/// one that takes its place, and a pass [bytes].
inline std::uint64_t working_room(const OpenNeeds& needs) { return 4 * needs.largest; }

}  // namespace translucube::server
