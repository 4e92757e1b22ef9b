#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "server/base/file.h"
#include "server/base/sha256.h"

namespace translucube::server {

/// A file that comes in parts, under a temporary name (is_temporary_name) until it is kept: what is
/// not is gone with the value. For one thread at a time. All throw FileError.
class ReceivedFile {
 public:
  /// At most `limit` bytes are to come, which the caller sees to.
  ReceivedFile(const std::filesystem::path& folder, std::uint64_t limit);
  ~ReceivedFile();
  ReceivedFile(const ReceivedFile&) = delete;
  ReceivedFile& operator=(const ReceivedFile&) = delete;

  std::uint64_t limit() const { return limit_; }
  void append(std::string_view bytes);
  std::uint64_t size() const { return size_; }
  Sha256 sha256() { return sum_.sum(); }  ///< of all that has come; once
  const std::filesystem::path& path() const { return path_; }
  void sync();  ///< its bytes are durable then
  /// Gives it a name on the same file system, durably.
  void keep(const std::filesystem::path& as);

 private:
  const std::uint64_t limit_;
  std::filesystem::path path_;  ///< empty once it is kept
  FileDescriptor file_;
  Sha256Sum sum_;
  std::uint64_t size_ = 0;
};

}  // namespace translucube::server
