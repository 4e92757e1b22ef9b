#include "server/base/file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "server/base/ids.h"

namespace translucube::server {
namespace {

constexpr std::string_view temporary_prefix = ".tmp-";

void sync(const std::filesystem::path& path, int flags) {
  const FileDescriptor fd(::open(path.c_str(), flags | O_CLOEXEC));
  if (!fd || ::fsync(fd.get()) != 0) fail(path, "make durable", errno);
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  const FileDescriptor fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (!fd) fail(path, "create", errno);
  write_bytes(fd, path, bytes);
}

std::string version_of(const struct stat& status) {
  std::string version = std::to_string(status.st_size);
  for (const timespec& time : {status.st_mtim, status.st_ctim})
    version += '.' + std::to_string(time.tv_sec) + '.' + std::to_string(time.tv_nsec);
  return version;
}

/// Removes a file when it goes out of scope, if it is still there.
struct Removal {
  std::filesystem::path path;
  ~Removal() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

}  // namespace

void fail(const std::filesystem::path& path, const char* doing, int error) {
  throw FileError(std::string("cannot ") + doing + ' ' + path.string() + ": " +
                  std::strerror(error));
}

void write_bytes(const FileDescriptor& file, const std::filesystem::path& path,
                 std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(path, "write", written < 0 ? errno : ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void sync_folder(const std::filesystem::path& folder) { sync(folder, O_RDONLY | O_DIRECTORY); }

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) ::close(fd_);
}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

std::shared_ptr<const OpenFile> OpenFile::open(const std::filesystem::path& path) {
  FileDescriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!fd) {
    if (errno == ENOENT || errno == ENOTDIR) return nullptr;
    fail(path, "open", errno);
  }
  return opened(std::move(fd), path.filename().string());
}

std::shared_ptr<const OpenFile> OpenFile::in_memory(
    const std::function<void(const std::filesystem::path&)>& writer) {
  FileDescriptor fd(::memfd_create("translucube", MFD_CLOEXEC));
  if (!fd) fail("a file in memory", "create", errno);
  writer("/proc/self/fd/" + std::to_string(fd.get()));
  return opened(std::move(fd), "a file in memory");
}

std::shared_ptr<const OpenFile> OpenFile::opened(FileDescriptor fd, std::string name) {
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) fail(name, "read", errno);
  auto file = std::make_shared<OpenFile>();
  file->fd_ = std::move(fd);
  file->size_ = static_cast<std::uint64_t>(status.st_size);
  file->version_ = version_of(status);
  file->name_ = std::move(name);
  return file;
}

bool OpenFile::is_as_opened() const {
  struct stat status {};
  return ::fstat(fd_.get(), &status) == 0 && status.st_nlink > 0 && version_of(status) == version_;
}

void OpenFile::read(std::uint64_t offset, char* buffer, std::size_t size) const {
  while (size > 0) {
    const ssize_t got = ::pread(fd_.get(), buffer, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail(name_, "read", got < 0 ? errno : EIO);
    offset += static_cast<std::uint64_t>(got);
    buffer += got;
    size -= static_cast<std::size_t>(got);
  }
}

std::string OpenFile::read_all() const {
  std::string bytes(size_, '\0');
  read(0, bytes.data(), bytes.size());
  return bytes;
}

Sha256 OpenFile::sha256() const {
  Sha256Sum sum;
  std::string part(std::min<std::uint64_t>(size_, 1 << 18), '\0');
  for (std::uint64_t at = 0; at < size_; at += part.size()) {
    part.resize(std::min<std::uint64_t>(part.size(), size_ - at));
    read(at, part.data(), part.size());
    sum.add(part);
  }
  return sum.sum();
}

std::filesystem::path write_atomically_named(
    const std::filesystem::path& folder, const std::string& extension,
    const std::function<void(const std::filesystem::path&)>& writer,
    const std::function<std::filesystem::path(const OpenFile&)>& name) {
  const std::filesystem::path temporary = temporary_path(folder, extension);
  const Removal removal{temporary};
  writer(temporary);
  sync(temporary, O_RDONLY);
  const auto written = OpenFile::open(temporary);
  if (!written) fail(temporary, "read", ENOENT);
  std::filesystem::path path = name(*written);
  if (::rename(temporary.c_str(), path.c_str()) != 0) fail(path, "name", errno);
  sync_folder(folder);
  return path;
}

void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path&)>& writer) {
  write_atomically_named(path.has_parent_path() ? path.parent_path() : std::filesystem::path("."),
                         path.extension().string(), writer, [&](const OpenFile&) { return path; });
}

void make_folder(const std::filesystem::path& folder) {
  if (::mkdir(folder.c_str(), 0700) == 0)
    sync_folder(folder.parent_path());
  else if (errno != EEXIST)
    fail(folder, "create", errno);
}

void write_atomically(const std::filesystem::path& path, std::string_view bytes) {
  write_atomically(path,
                   [&](const std::filesystem::path& temporary) { write_file(temporary, bytes); });
}

std::filesystem::path temporary_path(const std::filesystem::path& folder,
                                     const std::string& extension) {
  return folder / (std::string(temporary_prefix) + random_hex(8) + extension);
}

bool is_temporary_name(const std::string& filename) {
  return filename.starts_with(temporary_prefix);
}

}  // namespace translucube::server
