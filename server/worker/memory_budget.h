#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace translucube::server {

/// Shares the memory that there is among the jobs that are worked on at once. Safe to share by
/// threads; outlives its shares.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes) : bytes_(bytes) {}
  std::uint64_t bytes() const { return bytes_; }

  /// Kept as long as the job is worked on.
  using Share = std::shared_ptr<void>;
  /// Empty where it does not fit beside the others now; until it does, or is not asked for any
  /// more, no other job gets a share. Alone, a job gets what it asks for.
  Share take(const std::string& job_id, std::uint64_t bytes) {
    const auto now = Clock::now();
    const std::lock_guard lock(mutex_);
    if (!first_.empty() && first_ != job_id && now < first_until_) return nullptr;
    if (taken_ > 0 && taken_ + bytes > bytes_) {
      first_ = job_id;
      first_until_ = now + longest_silence;
      return nullptr;
    }
    first_.clear();
    taken_ += bytes;
    return {this, [bytes](void* budget) { static_cast<MemoryBudget*>(budget)->give_back(bytes); }};
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds longest_silence{5};

  void give_back(std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    taken_ -= bytes;
  }

  const std::uint64_t bytes_;
  std::mutex mutex_;
  std::uint64_t taken_ = 0;
  std::string first_;  ///< the job that waits for its share
  Clock::time_point first_until_;
};

}  // namespace translucube::server
