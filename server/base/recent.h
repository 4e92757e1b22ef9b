#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

namespace translucube::server {

/// Answers found out lately, by what was asked, so that to be asked again costs a look-up. Bounded:
/// once full it begins anew. An answer goes when it is older than `longest`, and by `forget`, which
/// also keeps out what was found out before it: take `now()` first, then find out, then `keep`.
template <typename Key, typename Value>
class Recent {
 public:
  using Clock = std::chrono::steady_clock;
  struct Moment {
    std::uint64_t epoch = 0;
    Clock::time_point time;
  };

  explicit Recent(std::size_t most, Clock::duration longest = Clock::duration::max())
      : most_(most), longest_(longest) {}

  std::optional<Value> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(key);
    if (known == known_.end()) return std::nullopt;
    if (Clock::now() - known->second.since <= longest_) return known->second.value;
    known_.erase(known);
    return std::nullopt;
  }

  Moment now() const {
    const std::lock_guard lock(mutex_);
    return {epoch_, Clock::now()};
  }

  void keep(const Key& key, Value value, const Moment& found) {
    const std::lock_guard lock(mutex_);
    if (found.epoch != epoch_) return;
    if (known_.size() >= most_) known_.clear();
    known_.insert_or_assign(key, Entry{std::move(value), found.time});
  }

  void forget() {
    const std::lock_guard lock(mutex_);
    ++epoch_;
    known_.clear();
  }

 private:
  struct Entry {
    Value value;
    Clock::time_point since;
  };
  const std::size_t most_;
  const Clock::duration longest_;
  mutable std::mutex mutex_;
  std::uint64_t epoch_ = 0;
  std::map<Key, Entry> known_;
};

}  // namespace translucube::server
