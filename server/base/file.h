#pragma once

// Files as they are served and made durable, over POSIX.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "server/base/sha256.h"

namespace translucube::server {

/// A file of ours could not be written or read: full disk, no permission, broken disk.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Owns a file descriptor.
class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  ~FileDescriptor();
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  explicit operator bool() const { return fd_ >= 0; }
  int get() const { return fd_; }

 private:
  int fd_;
};

/// A file held open: its bytes stay what they are though its name be removed or replaced.
class OpenFile {
 public:
  /// Empty if there is no such file. Throws FileError.
  static std::shared_ptr<const OpenFile> open(const std::filesystem::path& path);
  /// A file in memory, without a name, gone with the value. `writer` fills it under a path that
  /// holds while it does; its exceptions pass. Throws FileError.
  static std::shared_ptr<const OpenFile> in_memory(
      const std::function<void(const std::filesystem::path&)>& writer);

  std::uint64_t size() const { return size_; }
  /// Changes whenever the file is written anew or renamed: size, times of modification and change.
  const std::string& version() const { return version_; }
  /// Fills the buffer from the offset on. Throws FileError if the file has not that many bytes.
  void read(std::uint64_t offset, char* buffer, std::size_t size) const;
  std::string read_all() const;
  Sha256 sha256() const;  ///< of all bytes, read for it. Throws FileError.
  /// False once it was written, cut, replaced or removed.
  bool is_as_opened() const;

 private:
  static std::shared_ptr<const OpenFile> opened(FileDescriptor fd, std::string name);

  FileDescriptor fd_;
  std::uint64_t size_ = 0;
  std::string version_;
  std::string name_;
};

/// Writes a file so that under its name there is either the whole of it or what was there before,
/// also after a crash or on a full disk: a temporary name in the same folder, fsync, rename, fsync
/// of the folder. `writer` fills the temporary file, whose extension is that of `path`.
/// Throws FileError; exceptions of `writer` pass through; the temporary file is gone in any case.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path&)>& writer);

/// The same for a file whose name depends on its bytes: `name` is told the whole temporary file and
/// gives the path, in this folder. Returns it.
std::filesystem::path write_atomically_named(
    const std::filesystem::path& folder, const std::string& extension,
    const std::function<void(const std::filesystem::path&)>& writer,
    const std::function<std::filesystem::path(const OpenFile&)>& name);

/// Makes a folder that only its owner may enter, durably, in one that is there. Throws FileError.
void make_folder(const std::filesystem::path& folder);

/// Writes bytes that are at hand, likewise.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

/// A name that write_atomically uses on the way, and whether one is.
std::filesystem::path temporary_path(const std::filesystem::path& folder,
                                     const std::string& extension = {});
bool is_temporary_name(const std::string& filename);

// The steps of it. Each throws FileError.
[[noreturn]] void fail(const std::filesystem::path& path, const char* doing, int error);
void write_bytes(const FileDescriptor& file, const std::filesystem::path& path,
                 std::string_view bytes);
void sync_folder(const std::filesystem::path& folder);

}  // namespace translucube::server
