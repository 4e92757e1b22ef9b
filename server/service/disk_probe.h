#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "server/store/artifact_store.h"
#include "server/store/job_store.h"

namespace translucube::server {

/// Whether the disk takes what is written. Asked often, it writes once a second, in a thread of its
/// own: a disk that is slow keeps nobody waiting. Safe to share by threads. The stores outlive it.
class DiskProbe {
 public:
  DiskProbe(JobStore& store, ArtifactStore& artifacts);

  /// Why not; empty where it does. What is said was found out a second ago at most, unless the disk
  /// needs longer to tell.
  std::optional<std::string> failure();

 private:
  using Time = std::chrono::steady_clock::time_point;

  void probe_when_asked(const std::stop_token& stop);
  std::optional<std::string> probe() const;

  JobStore& store_;
  ArtifactStore& artifacts_;
  std::mutex mutex_;
  std::condition_variable_any asked_, told_;
  bool is_asked_ = false;
  std::optional<Time> begun_, told_at_;  ///< of the probe under way, and of the last
  std::optional<std::string> failure_;
  std::jthread thread_;  ///< last: ends before what it uses
};

}  // namespace translucube::server
