#pragma once

#include <cstdint>
#include <filesystem>

namespace translucube::server {

/// The memory that this process may take [bytes]: the machine's, or less where its control group
/// (cgroups(7), versions 1 and 2) or its limit of address space allows less.
std::uint64_t available_memory();

/// What the files of control groups below `mounts` allow a process whose /proc/self/cgroup is
/// `membership`.
std::uint64_t group_memory(const std::filesystem::path& mounts,
                           const std::filesystem::path& membership);

}  // namespace translucube::server
