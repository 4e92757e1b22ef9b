#include "server/service/janitor.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "server/base/ids.h"
#include "server/pictures/image_artifacts.h"
#include "server/store/content.h"

namespace translucube::server {

void Janitor::clean_up() {
  for (const std::string& folder : artifacts_.ids()) {
    if (!is_id(folder) && !is_content_key(folder)) continue;
    const std::optional<StoredResult> result = store_.find_result(folder);
    const std::optional<Job> job = is_id(folder) ? store_.find(folder) : std::nullopt;
    const bool open = job && !api::is_end(job->state);
    if (result)
      remove_derived(*result);
    else if (!open)
      artifacts_.remove_all(folder);
  }
}

/// All but the picture, and the path lengths beside it; the bytes that are left.
std::uint64_t Janitor::remove_derived(const StoredResult& result) {
  for (const std::string& name : artifacts_.names(result.content))
    if (name != result.image && name != explorable_name(result.image))
      artifacts_.remove(result.content, name);
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

void Janitor::discard(const std::string& folder) {
  try {
    artifacts_.remove_all(folder);
  } catch (const FileError& error) {
    spdlog::warn("{}: {}", folder, error.what());
  }
}

void Janitor::discard(const StoredResult& result) {
  try {
    remove_files(artifacts_, result);
  } catch (const FileError& error) {
    spdlog::warn("result {}: {}", result.content, error.what());
  }
}

}  // namespace translucube::server
