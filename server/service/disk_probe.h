#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "server/store/artifact_store.h"
#include "server/store/data_folder.h"
#include "server/store/job_store.h"

namespace translucube::server {

/// Whether the disk takes what is written, and has room for what was accepted. Asked often, it
/// looks once a second, in a thread of its own: a disk that is slow keeps nobody waiting. Safe to
/// share by threads. The stores and the folder outlive it.
class DiskProbe {
 public:
  DiskProbe(JobStore& store, ArtifactStore& artifacts, const DataFolder& folder,
            std::uint64_t quota_bytes);

  /// Why not; empty where it does. What is said was found out a second ago at most, unless the disk
  /// needs longer to tell.
  std::optional<std::string> failure();
  /// The same for new work, whose pictures take so many bytes: they are counted from here on.
  std::optional<std::string> refusal(std::uint64_t picture_bytes);

 private:
  using Time = std::chrono::steady_clock::time_point;
  struct Found {
    std::optional<std::string> failure;
    std::int64_t left = 0;  ///< of the disk, beside what was accepted [bytes]
  };

  void probe_when_asked(const std::stop_token& stop);
  Found look() const;

  JobStore& store_;
  ArtifactStore& artifacts_;
  const DataFolder& folder_;
  const std::uint64_t quota_bytes_;
  std::mutex mutex_;
  std::condition_variable_any asked_, told_;
  bool is_asked_ = false;
  std::optional<Time> begun_, told_at_;  ///< of the look under way, and of the last
  Found found_;
  std::jthread thread_;  ///< last: ends before what it uses
};

/// What the job with the largest pictures needs while it is worked on: them, and its film [bytes].
inline std::uint64_t working_room(std::uint64_t largest_pictures) { return 2 * largest_pictures; }

}  // namespace translucube::server
