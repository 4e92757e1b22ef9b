#include "server/base/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include "api/base/text.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();

std::uint64_t number_in(const fs::path& file) {
  std::string text;
  std::ifstream(file) >> text;
  return api::number_of<std::uint64_t>(text).value_or(any);  // "max", or no such file
}

/// The least that the group or one above it allows.
std::uint64_t least(const fs::path& mount, fs::path group, const char* name) {
  std::uint64_t bytes = number_in(mount / name);
  for (; !group.empty() && group != group.root_path(); group = group.parent_path())
    bytes = std::min(bytes, number_in(mount / group.relative_path() / name));
  return bytes;
}

}  // namespace

std::uint64_t group_memory(const fs::path& mounts, const fs::path& membership) {
  std::uint64_t bytes = any;
  std::ifstream file(membership);
  for (std::string line; std::getline(file, line);) {  // "0::/group" or "4:memory:/group"
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == line.npos || second == line.npos) continue;
    const std::string kinds = line.substr(first + 1, second - first - 1);
    const fs::path group = line.substr(second + 1);
    if (kinds.empty())
      bytes = std::min(bytes, least(mounts, group, "memory.max"));
    else if ((',' + kinds + ',').find(",memory,") != std::string::npos)
      bytes = std::min(bytes, least(mounts / "memory", group, "memory.limit_in_bytes"));
  }
  return bytes;
}

std::uint64_t available_memory() {
  const auto pages = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE));
  std::uint64_t bytes = std::min(pages * page, group_memory("/sys/fs/cgroup", "/proc/self/cgroup"));
  rlimit space{};
  if (::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    bytes = std::min<std::uint64_t>(bytes, space.rlim_cur);
  return bytes;
}

}  // namespace translucube::server
