#include "server/service/changes.h"

namespace translucube::server {

void Changes::tell() {
  {
    const std::lock_guard lock(mutex_);
    ++changes_;
  }
  change_.notify_all();
}

void Changes::watch(std::chrono::milliseconds time, const std::function<bool()>& look) {
  const auto deadline = std::chrono::steady_clock::now() + time;
  while (true) {
    std::uint64_t seen = 0;
    {
      const std::lock_guard lock(mutex_);
      seen = changes_;
    }
    if (look()) return;
    std::unique_lock lock(mutex_);
    if (!change_.wait_until(lock, deadline, [&] { return changes_ != seen || ended_; }) || ended_)
      return;
  }
}

void Changes::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  change_.notify_all();
}

bool Changes::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

}  // namespace translucube::server
