#pragma once

// Files that strangers can name are parsed in a process without rights: another program
// (renderer/reader), which is handed one open file and a place for its answer, and gives up all
// else. What it says is checked like any word of a stranger. This room starts that process and is
// what the process confines itself with; it knows no format.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace translucube {

/// What a process in the sandbox may use.
struct SandboxLimits {
  std::uint64_t file_bytes = std::uint64_t{1} << 31;
  std::uint64_t answer_bytes = std::uint64_t{1} << 32;
  std::uint64_t memory_bytes = std::uint64_t{1} << 33;  ///< of address space
  unsigned cpu_seconds = 60;
  unsigned wall_seconds = 120;
};
inline constexpr SandboxLimits sandbox_limits{};

/// The file is at fault, and why: it cannot be read whoever tries.
struct FileRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The machine is at fault, and why: the file may be readable at another time.
struct FileUnavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The answer of a process in the sandbox, which has ended.
class SandboxAnswer {
 public:
  explicit SandboxAnswer(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Has the reader's process read a file as a `kind` that it knows. Throws FileRefused where it
/// refuses, crashes or takes more than the limits, FileUnavailable where the file cannot be opened
/// or no process be had.
SandboxAnswer read_in_sandbox(const std::string& kind, const std::filesystem::path& file,
                              const SandboxLimits& limits = sandbox_limits);

}  // namespace translucube
