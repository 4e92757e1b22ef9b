#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "server/store/artifact_store.h"
#include "server/store/job_store.h"

namespace translucube::server {

/// Removes files that nobody will ask for, and results that were not asked for longest where they
/// take more than their quota. Safe to share by threads. The stores outlive it.
class Janitor {
 public:
  Janitor(JobStore& store, ArtifactStore& artifacts) : store_(store), artifacts_(artifacts) {}

  /// What a crash left: films of jobs that have ended, files of what the store knows to be removed.
  /// Derived pictures go too: the colour config may be another one since they were made. A folder
  /// that the store does not know stays, and is told: nothing says that it may go. For the start,
  /// while nobody works. Throws StoreError, FileError.
  void clean_up();

  /// Removes results until what is left is nine tenths of the quota: first what is derived, then
  /// the pictures. The same request makes them again. True where a result was removed.
  bool keep_within(std::uint64_t quota_bytes);

  /// Removes the folder of a job or a sweep, or a result's files. What cannot be removed now,
  /// because a worker is writing there for a moment yet, is removed by that worker or at the next
  /// start.
  void discard(const std::string& folder);
  void discard(const StoredResult& result);

 private:
  bool clean_up(const std::string& folder);
  void discard(const Leftover& removed);
  std::uint64_t remove_derived(const StoredResult& result);
  bool remove_results(std::uint64_t bytes, std::uint64_t goal);

  JobStore& store_;
  ArtifactStore& artifacts_;
  std::mutex at_work_;
};

}  // namespace translucube::server
