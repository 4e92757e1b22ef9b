#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "api/request/upload.h"
#include "server/base/received_file.h"

namespace translucube::server {

struct Upload {
  api::UploadKind kind = api::UploadKind::mesh;
  std::string sha256;
  std::uint64_t bytes = 0;
  std::int64_t uploaded_ms = 0, used_ms = 0;  ///< `used`: sent again, or named by a request
};

/// The uploads of a service, each a file that its bytes name: <root>/meshes/<sha256>. A name holds
/// the whole of its file, or there is none. The disk is all that it knows, so that what is put
/// there or removed by hand counts. Safe to share by threads. Every function throws FileError where
/// the disk refuses.
class UploadStore {
 public:
  /// Creates the folder, in one that is there; removes what a crash left half-written.
  UploadStore(std::filesystem::path root, std::uint64_t quota_bytes);

  std::optional<Upload> find(api::UploadKind kind, const std::string& sha256) const;
  std::vector<Upload> list(api::UploadKind kind) const;  ///< the newest first
  std::uint64_t bytes() const;                           ///< of all, as the quota counts them

  /// Room for so many bytes, until it is given back: by then they are kept, or are not to be. Null
  /// where quota or disk do not have it.
  using Room = std::shared_ptr<void>;
  Room reserve(std::uint64_t bytes);
  const std::filesystem::path& folder() const { return root_; }  ///< for what is received
  /// True where it was not there.
  bool keep(ReceivedFile& file, api::UploadKind kind, const std::string& sha256);
  void remove(const Upload& upload);

 private:
  const std::filesystem::path root_;
  const std::uint64_t quota_bytes_;
  std::mutex mutex_;
  std::uint64_t reserved_ = 0;
};

/// Notes that an upload was used now; where it is not, or cannot be noted, nothing happens.
void touch_upload(const std::filesystem::path& file);

}  // namespace translucube::server
