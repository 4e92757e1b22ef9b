#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>

#include "server/base/places.h"

namespace translucube::server {

/// A bound on how many do something at once, with a line of those that wait for it: bounded too,
/// in number and in time.
class Turns {
 public:
  Turns(std::size_t at_once, std::size_t in_line, std::chrono::milliseconds longest_wait)
      : at_once_(at_once), in_line_(in_line), longest_wait_(longest_wait) {}

  /// A turn, until it is destroyed, which the object outlives; null where the line is full or took
  /// too long.
  Places::Place take() {
    std::unique_lock lock(mutex_);
    if (taken_ == at_once_) {
      if (waiting_ == in_line_) return nullptr;
      ++waiting_;
      const bool free = free_.wait_for(lock, longest_wait_, [this] { return taken_ < at_once_; });
      --waiting_;
      if (!free) return nullptr;
    }
    ++taken_;
    return {this, [](void* turns) { static_cast<Turns*>(turns)->give_back(); }};
  }

 private:
  void give_back() {
    {
      const std::lock_guard lock(mutex_);
      --taken_;
    }
    free_.notify_one();
  }

  const std::size_t at_once_, in_line_;
  const std::chrono::milliseconds longest_wait_;
  std::mutex mutex_;
  std::condition_variable free_;
  std::size_t taken_ = 0, waiting_ = 0;
};

}  // namespace translucube::server
