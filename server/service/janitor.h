#pragma once

#include <atomic>
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

  /// Removes files until what is left is nine tenths of the quota, or until `room` bytes are free
  /// on the disk: first what is derived, then the pictures that were unused longest. The same
  /// request makes them again. True where a result was removed.
  bool keep_within(std::uint64_t quota_bytes, std::uint64_t room);
  /// True if films of jobs that were begun take what the quota leaves: nothing more is to be begun.
  bool crowded() const { return crowded_; }
  /// Where so many bytes are not free, removes films of renders that wait, of the newest first and
  /// not of the oldest, which comes to its end then: they are traced again.
  void give_way(std::uint64_t room);
  /// Removes some of the renders and sweeps that ended before this time, with the pictures that
  /// nothing else shows; how many.
  std::size_t forget_old(std::int64_t before_ms);

  /// Removes the folder of a job or a sweep, or a result's files. What cannot be removed now,
  /// because a worker is writing there for a moment yet, is removed by that worker or at the next
  /// start.
  void discard(const std::string& folder);
  void discard(const StoredResult& result);

 private:
  bool clean_up(const std::string& folder);
  void discard(const Leftover& removed);
  std::uint64_t remove_derived(const StoredResult& result);
  std::uint64_t excess(std::uint64_t quota_bytes, std::uint64_t room) const;
  void remove_sheets();
  bool make_room(std::uint64_t bytes);
  void evict(const StoredResult& result);

  JobStore& store_;
  ArtifactStore& artifacts_;
  std::mutex at_work_;
  std::atomic<bool> crowded_ = false;
};

}  // namespace translucube::server
