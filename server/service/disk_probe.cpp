#include "server/service/disk_probe.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace translucube::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::chrono::seconds fresh(1);
// What a probe may be kept waiting; and how long a disk may take before it counts as broken.
constexpr milliseconds patience(20);
constexpr std::chrono::seconds hanging(10);

constexpr const char* no_room = "The disk of the service has no room for what it has accepted.";

}  // namespace

DiskProbe::DiskProbe(JobStore& store, ArtifactStore& artifacts, const DataFolder& folder,
                     std::uint64_t quota_bytes)
    : store_(store),
      artifacts_(artifacts),
      folder_(folder),
      quota_bytes_(quota_bytes),
      thread_([this](const std::stop_token& stop) { probe_when_asked(stop); }) {}

std::optional<std::string> DiskProbe::failure() {
  std::unique_lock lock(mutex_);
  const auto is_fresh = [this] { return told_at_ && steady_clock::now() - *told_at_ < fresh; };
  if (is_fresh()) return found_.failure;
  is_asked_ = true;
  asked_.notify_one();
  // As long as nothing was ever found out, nothing can be said.
  if (told_.wait_for(lock, told_at_ ? patience : milliseconds(hanging), is_fresh))
    return found_.failure;
  if (begun_ && steady_clock::now() - *begun_ > hanging)
    return "The disk of the service does not answer.";
  return found_.failure;
}

std::optional<std::string> DiskProbe::refusal(std::uint64_t picture_bytes) {
  if (auto why = failure()) return why;
  const std::lock_guard lock(mutex_);
  const auto more = static_cast<std::int64_t>(picture_bytes + working_room(picture_bytes));
  if (more > found_.left) return no_room;
  found_.left -= static_cast<std::int64_t>(std::min(picture_bytes, quota_bytes_));
  return std::nullopt;
}

void DiskProbe::probe_when_asked(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (asked_.wait(lock, stop, [this] { return is_asked_; })) {
    begun_ = steady_clock::now();
    lock.unlock();
    Found found = look();
    lock.lock();
    is_asked_ = false;
    begun_.reset();
    told_at_ = steady_clock::now();
    found_ = std::move(found);
    told_.notify_all();
  }
}

/// Pictures that are there give way to those that were accepted, as they do within the quota.
DiskProbe::Found DiskProbe::look() const {
  try {
    folder_.check();
    store_.check_writable();
    artifacts_.check_writable();
    const OpenNeeds needs = store_.open_needs();
    const std::uint64_t wanted = std::min(needs.bytes, quota_bytes_) + working_room(needs.largest);
    Found found;
    found.left = static_cast<std::int64_t>(artifacts_.free_bytes() + store_.result_bytes()) -
                 static_cast<std::int64_t>(wanted);
    if (found.left < 0 && needs.bytes > 0) found.failure = no_room;
    return found;
  } catch (const std::exception& error) {
    spdlog::error("not ready: {}", error.what());
    return {"The disk of the service is full or cannot be used.", 0};
  }
}

}  // namespace translucube::server
