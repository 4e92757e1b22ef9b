#include "server/service/disk_probe.h"

#include <spdlog/spdlog.h>

namespace translucube::server {

std::optional<std::string> DiskProbe::failure() {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (probed_at_ && now - *probed_at_ < std::chrono::seconds(1)) return failure_;
  probed_at_ = now;
  failure_.reset();
  try {
    store_.check_writable();
    artifacts_.check_writable();
  } catch (const std::exception& error) {
    spdlog::error("not ready: {}", error.what());
    failure_ = "The disk of the service is full or cannot be used.";
  }
  return failure_;
}

}  // namespace translucube::server
