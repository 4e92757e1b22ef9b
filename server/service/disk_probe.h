#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "server/store/artifact_store.h"
#include "server/store/job_store.h"

namespace translucube::server {

/// Whether the disk takes what is written. Asked often, it writes once a second. Safe to share by
/// threads. The stores outlive it.
class DiskProbe {
 public:
  DiskProbe(JobStore& store, ArtifactStore& artifacts) : store_(store), artifacts_(artifacts) {}

  /// Why not; empty where it does.
  std::optional<std::string> failure();

 private:
  JobStore& store_;
  ArtifactStore& artifacts_;
  std::mutex mutex_;
  std::optional<std::chrono::steady_clock::time_point> probed_at_;
  std::optional<std::string> failure_;
};

}  // namespace translucube::server
