#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>

namespace translucube::server {

/// Tells those who wait for it, in long polls and event streams, that something has changed; they
/// look for themselves what it is. Safe to share by threads.
class Changes {
 public:
  void tell();
  /// Calls `look` now and after every change, until it returns true, the time is over or the
  /// waiting has ended for all.
  void watch(std::chrono::milliseconds time, const std::function<bool()>& look);

  void end();  ///< nobody waits from here on
  bool ended() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable change_;
  std::uint64_t changes_ = 0;
  bool ended_ = false;
};

}  // namespace translucube::server
