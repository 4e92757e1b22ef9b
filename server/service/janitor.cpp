#include "server/service/janitor.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "server/base/ids.h"
#include "server/pictures/image_artifacts.h"
#include "server/store/content.h"

namespace translucube::server {
namespace {

// Each takes a write to the disk.
constexpr int most_forgotten_at_once = 50;

}  // namespace

void Janitor::clean_up() {
  for (const Leftover& removed : store_.leftovers()) discard(removed);
  std::size_t unknown = 0;
  for (const std::string& folder : artifacts_.ids()) {
    if (clean_up(folder)) continue;
    artifacts_.leave_alone(folder);
    ++unknown;
  }
  if (unknown > 0)
    spdlog::warn(
        "{} folders of pictures are unknown to the job store, which may be older than they are: "
        "they stay as they are",
        unknown);
}

/// False where the store knows nothing of the folder.
bool Janitor::clean_up(const std::string& folder) {
  if (const auto result = store_.find_result(folder)) {
    remove_derived(*result);
    return true;
  }
  if (!is_id(folder)) return false;
  const std::optional<Job> job = store_.find(folder);
  if (!job && !store_.find_sweep(folder)) return false;
  if (!job || api::is_end(job->state)) artifacts_.remove_all(folder);  // films, or sheets
  return true;
}

/// The bytes that are left.
std::uint64_t Janitor::remove_derived(const StoredResult& result) {
  for (const std::string& name : artifacts_.names(result.content))
    if (is_derived(name)) artifacts_.remove(result.content, name);
  const std::uint64_t left = artifacts_.bytes(result.content);
  try {
    store_.resize_result(result.content, left);
  } catch (const StoreError& error) {  // a full disk, which this makes room on
    spdlog::warn("{}", error.what());
  }
  return left;
}

/// What has to go, in bytes.
std::uint64_t Janitor::excess(std::uint64_t quota_bytes, std::uint64_t room) const {
  const std::uint64_t bytes = artifacts_.figures().bytes, free = artifacts_.free_bytes();
  const std::uint64_t over = bytes > quota_bytes ? bytes - (quota_bytes - quota_bytes / 10) : 0;
  return std::max(over, room > free ? room - free : 0);
}

bool Janitor::keep_within(std::uint64_t quota_bytes, std::uint64_t room) {
  const std::unique_lock lock(at_work_, std::try_to_lock);
  if (!lock) return false;
  bool removed = false;
  try {
    if (const std::uint64_t bytes = excess(quota_bytes, room)) removed = make_room(bytes);
  } catch (const std::exception& error) {  // StoreError, FileError
    spdlog::error("no room made: {}", error.what());
    removed = true;
  }
  crowded_ = artifacts_.figures().bytes > quota_bytes;
  return removed;
}

void Janitor::give_way(std::uint64_t room) {
  if (artifacts_.free_bytes() >= room) return;
  std::vector<std::string> begun;
  for (const std::string& folder : artifacts_.ids())
    if (is_id(folder))
      if (const auto job = store_.find(folder); job && !api::is_end(job->state))
        begun.push_back(folder);
  std::ranges::sort(begun);
  while (begun.size() > 1 && artifacts_.free_bytes() < room) {
    if (store_.find(begun.back())->state == api::JobState::queued) {
      spdlog::warn("render {}: its films give way on a full disk", begun.back());
      artifacts_.remove_all(begun.back());
    }
    begun.pop_back();
  }
}

void Janitor::remove_sheets() {
  for (const std::string& folder : artifacts_.ids())
    if (is_id(folder))
      for (const std::string& name : artifacts_.names(folder))
        if (is_derived(name)) artifacts_.remove(folder, name);
}

bool Janitor::make_room(std::uint64_t bytes) {
  const std::uint64_t before = artifacts_.figures().bytes;
  const auto missing = [&] {
    const std::uint64_t freed = before - std::min(before, artifacts_.figures().bytes);
    return bytes - std::min(bytes, freed);
  };
  remove_sheets();
  for (const StoredResult& result : store_.least_recently_used(missing())) {
    if (missing() == 0) return false;
    remove_derived(result);
  }
  bool removed = false;
  for (const StoredResult& result : store_.least_recently_used(missing())) {
    if (missing() == 0) break;
    evict(result);
    removed = true;
  }
  return removed;
}

/// The row first, so that nobody is promised what is gone; but on a full disk there is no room for
/// that either, until the file has gone.
void Janitor::evict(const StoredResult& result) {
  try {
    if (!store_.remove_result(result)) return;
  } catch (const StoreError&) {
    remove_files(artifacts_, result);
    store_.lose_result(result);
  }
  spdlog::info("result {} removed to make room", result.content);
  discard(result);
}

std::size_t Janitor::forget_old(std::int64_t before_ms) {
  const std::vector<std::string> old = store_.ended_before(before_ms, most_forgotten_at_once);
  for (const std::string& id : old) {
    std::vector<std::string> images;
    for (const SweepImageState& image : store_.sweep_images(id)) images.push_back(image.job_id);
    const auto unused = store_.remove(id);
    if (!unused) continue;
    for (const StoredResult& result : *unused) discard(result);
    for (const std::string& image : images) discard(image);
    discard(id);
  }
  return old.size();
}

void Janitor::discard(const Leftover& removed) {
  try {
    if (removed.image.empty())
      artifacts_.remove_all(removed.folder);
    else if (const auto now = store_.find_result(removed.folder);
             !now || now->image != removed.image)
      remove_files(artifacts_, {removed.folder, removed.image, {}, 0, {}});
    store_.forget(removed);
  } catch (const std::runtime_error& error) {  // StoreError, FileError
    spdlog::warn("{}: {}", removed.folder, error.what());
  }
}

void Janitor::discard(const std::string& folder) { discard(Leftover{folder, {}}); }
void Janitor::discard(const StoredResult& result) {
  discard(Leftover{result.content, result.image});
}

}  // namespace translucube::server
