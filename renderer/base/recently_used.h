#pragma once

#include <algorithm>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>

namespace translucube {

/// Values by their keys, those that were used last; to make one takes long. Safe to share by
/// threads.
template <typename Key, typename Value>
class RecentlyUsed {
 public:
  using Shared = std::shared_ptr<const Value>;

  /// `most_size`: of all that is kept, the last one apart.
  explicit RecentlyUsed(std::uint64_t most_size) : most_size_(most_size) {}

  Shared find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(entries_, key, &Entry::key);
    if (found == entries_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found);
    return found->value;
  }

  void keep(const Key& key, Shared value, std::uint64_t size) {
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [&](const Entry& entry) { return entry.key == key; });
    entries_.push_front({key, std::move(value), size});
    std::uint64_t kept = 0;
    for (const Entry& entry : entries_) kept += entry.size;
    for (; kept > most_size_ && entries_.size() > 1; entries_.pop_back())
      kept -= entries_.back().size;
  }

  /// Forgets the values of the keys for which `stale` holds.
  template <typename Stale>
  void forget_if(const Stale& stale) {
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [&](const Entry& entry) { return stale(entry.key); });
  }

 private:
  struct Entry {
    Key key;
    Shared value;
    std::uint64_t size;
  };

  const std::uint64_t most_size_;
  std::mutex mutex_;
  std::list<Entry> entries_;  ///< the latest first
};

}  // namespace translucube
