#include "server/service/disk_probe.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace translucube::server {
namespace {

constexpr const char* no_room = "The disk of the service has no room for what it has accepted.";

}  // namespace

std::optional<std::string> DiskProbe::failure() {
  const std::lock_guard lock(mutex_);
  look();
  return failure_;
}

std::optional<std::string> DiskProbe::refusal(std::uint64_t picture_bytes) {
  const std::lock_guard lock(mutex_);
  look();
  if (failure_) return failure_;
  const auto more = static_cast<std::int64_t>(picture_bytes + working_room(picture_bytes));
  if (more > left_) return no_room;
  left_ -= static_cast<std::int64_t>(std::min(picture_bytes, quota_bytes_));
  return std::nullopt;
}

/// Pictures that are there give way to those that were accepted, as they do within the quota.
void DiskProbe::look() {
  const auto now = std::chrono::steady_clock::now();
  if (probed_at_ && now - *probed_at_ < std::chrono::seconds(1)) return;
  probed_at_ = now;
  failure_.reset();
  try {
    folder_.check();
    store_.check_writable();
    artifacts_.check_writable();
    const OpenNeeds needs = store_.open_needs();
    const std::uint64_t wanted = std::min(needs.bytes, quota_bytes_) + working_room(needs.largest);
    left_ = static_cast<std::int64_t>(artifacts_.free_bytes() + store_.result_bytes()) -
            static_cast<std::int64_t>(wanted);
    if (left_ < 0 && needs.bytes > 0) failure_ = no_room;
  } catch (const std::exception& error) {
    spdlog::error("not ready: {}", error.what());
    failure_ = "The disk of the service is full or cannot be used.";
  }
}

}  // namespace translucube::server
