#pragma once

#include <atomic>
#include <memory>

namespace translucube::server {

/// A bound on how many do something at once.
class Places {
 public:
  explicit Places(int count) : free_(count) {}

  /// One place, until it is destroyed; null where all are taken.
  using Place = std::shared_ptr<void>;
  Place take() {
    for (int free = free_; free > 0;)
      if (free_.compare_exchange_weak(free, free - 1))
        return {this, [](void* places) { ++static_cast<Places*>(places)->free_; }};
    return nullptr;
  }
  int free() const { return free_; }

 private:
  std::atomic<int> free_;
};

}  // namespace translucube::server
