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
  /// The same for new work, whose pictures take so many bytes: they are counted from here on.
  std::optional<std::string> refusal(std::uint64_t picture_bytes);

 private:
  void look();

  JobStore& store_;
  ArtifactStore& artifacts_;
  const DataFolder& folder_;
  const std::uint64_t quota_bytes_;
  std::mutex mutex_;
  std::optional<std::chrono::steady_clock::time_point> probed_at_;
  std::optional<std::string> failure_;
  std::int64_t left_ = 0;  ///< of the disk, beside what was accepted [bytes]
};

/// What the job with the largest pictures needs while it is worked on: them, and its film [bytes].
inline std::uint64_t working_room(std::uint64_t largest_pictures) { return 2 * largest_pictures; }

}  // namespace translucube::server
