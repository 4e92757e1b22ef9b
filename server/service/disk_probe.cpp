#include "server/service/disk_probe.h"

#include <spdlog/spdlog.h>

namespace translucube::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::chrono::seconds fresh(1);
// What a probe may be kept waiting; and how long a disk may take before it counts as broken.
constexpr milliseconds patience(20);
constexpr std::chrono::seconds hanging(10);

}  // namespace

DiskProbe::DiskProbe(JobStore& store, ArtifactStore& artifacts)
    : store_(store),
      artifacts_(artifacts),
      thread_([this](const std::stop_token& stop) { probe_when_asked(stop); }) {}

std::optional<std::string> DiskProbe::failure() {
  std::unique_lock lock(mutex_);
  const auto is_fresh = [this] { return told_at_ && steady_clock::now() - *told_at_ < fresh; };
  if (is_fresh()) return failure_;
  is_asked_ = true;
  asked_.notify_one();
  // As long as nothing was ever found out, nothing can be said.
  if (told_.wait_for(lock, told_at_ ? patience : milliseconds(hanging), is_fresh)) return failure_;
  if (begun_ && steady_clock::now() - *begun_ > hanging)
    return "The disk of the service does not answer.";
  return failure_;
}

void DiskProbe::probe_when_asked(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (asked_.wait(lock, stop, [this] { return is_asked_; })) {
    begun_ = steady_clock::now();
    lock.unlock();
    std::optional<std::string> found = probe();
    lock.lock();
    is_asked_ = false;
    begun_.reset();
    told_at_ = steady_clock::now();
    failure_ = std::move(found);
    told_.notify_all();
  }
}

std::optional<std::string> DiskProbe::probe() const {
  try {
    store_.check_writable();
    artifacts_.check_writable();
    return std::nullopt;
  } catch (const std::exception& error) {
    spdlog::error("not ready: {}", error.what());
    return "The disk of the service is full or cannot be used.";
  }
}

}  // namespace translucube::server
