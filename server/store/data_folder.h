#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "server/base/file.h"

namespace translucube::server {

/// The folder of one running service, for its user alone. Holds exclusive locks on it (released by
/// the kernel however the process ends), so that two services never share a queue by accident.
class DataFolder {
 public:
  /// Creates the folder if it is not there, and closes one that is there to other users. Throws
  /// StoreError if it cannot be written or belongs to another running service.
  explicit DataFolder(std::filesystem::path folder);

  std::filesystem::path store_file() const { return folder_ / "jobs.sqlite"; }
  std::filesystem::path artifacts() const { return folder_ / "artifacts"; }
  std::filesystem::path uploads() const { return folder_ / "uploads"; }
  std::filesystem::path crash_mark() const { return folder_ / "crashed"; }

  /// Throws StoreError where the folder, its lock or the store's file is no longer what it was when
  /// this was asked first: what is written now would be lost. Safe to share by threads.
  void check() const;

 private:
  using Identity = std::pair<std::uint64_t, std::uint64_t>;  ///< device and number of a file
  static std::optional<Identity> identity(const std::filesystem::path& path);
  [[noreturn]] void refuse(const std::string& reason) const;
  FileDescriptor locked(const std::filesystem::path& path, int flags) const;

  std::filesystem::path folder_;
  FileDescriptor folder_lock_, lock_;  ///< of the folder itself, and of the file that old ones lock
  std::optional<Identity> folder_identity_, lock_identity_;
  mutable std::mutex mutex_;
  mutable std::optional<Identity> store_identity_;
};

}  // namespace translucube::server
