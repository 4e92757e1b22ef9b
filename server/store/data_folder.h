#pragma once

#include <filesystem>
#include <memory>

#include "server/base/file.h"

namespace translucube::server {

/// The folder of one running service. Holds an exclusive lock on it (released by the kernel however
/// the process ends), so that two services never share a queue by accident.
class DataFolder {
 public:
  /// Creates the folder if it is not there. Throws StoreError if it cannot be written or belongs to
  /// another running service.
  explicit DataFolder(std::filesystem::path folder);

  std::filesystem::path store_file() const { return folder_ / "jobs.sqlite"; }
  std::filesystem::path artifacts() const { return folder_ / "artifacts"; }

 private:
  std::filesystem::path folder_;
  FileDescriptor lock_;
};

}  // namespace translucube::server
