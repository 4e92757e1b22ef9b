#include "server/service/disk_probe.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace translucube::server {

std::optional<std::string> DiskProbe::failure() {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (probed_at_ && now - *probed_at_ < std::chrono::seconds(1)) return failure_;
  probed_at_ = now;
  failure_.reset();
  try {
    folder_.check();
    store_.check_writable();
    artifacts_.check_writable();
    if (!has_room()) failure_ = "The disk of the service has no room for what it has accepted.";
  } catch (const std::exception& error) {
    spdlog::error("not ready: {}", error.what());
    failure_ = "The disk of the service is full or cannot be used.";
  }
  return failure_;
}

/// Pictures that are there give way to those that were accepted, as they do within the quota.
bool DiskProbe::has_room() const {
  const OpenNeeds needs = store_.open_needs();
  if (needs.bytes == 0) return true;
  const std::uint64_t wanted = std::min(needs.bytes, quota_bytes_) + working_room(needs);
  return artifacts_.free_bytes() + store_.result_bytes() >= wanted;
}

}  // namespace translucube::server
