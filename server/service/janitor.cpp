#include "server/service/janitor.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "server/base/ids.h"
#include "server/pictures/image_artifacts.h"
#include "server/store/content.h"

namespace translucube::server {

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
  store_.resize_result(result.content, left);
  return left;
}

bool Janitor::keep_within(std::uint64_t quota_bytes) {
  const std::unique_lock lock(at_work_, std::try_to_lock);
  if (!lock) return false;
  try {
    const std::uint64_t bytes = store_.result_bytes();
    return bytes > quota_bytes && remove_results(bytes, quota_bytes - quota_bytes / 10);
  } catch (const std::runtime_error& error) {
    spdlog::error("no room made: {}", error.what());
    return true;
  }
}

bool Janitor::remove_results(std::uint64_t bytes, std::uint64_t goal) {
  for (const StoredResult& result : store_.least_recently_used(bytes - goal)) {
    if (bytes <= goal) return false;
    const std::uint64_t left = remove_derived(result);
    bytes -= std::min(bytes, result.bytes - std::min(result.bytes, left));
  }
  bool removed = false;
  for (const StoredResult& result : store_.least_recently_used(bytes > goal ? bytes - goal : 0)) {
    if (!store_.remove_result(result)) continue;
    spdlog::info("result {} removed to make room", result.content);
    discard(result);
    removed = true;
  }
  return removed;
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
