#include "server/store/data_folder.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "server/store/store_error.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

/// Takes the rights of other users. The folder of another user may be lent: then it stays.
void close_to_others(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || (status.st_mode & 077) == 0) return;
  if (::chmod(path.c_str(), status.st_mode & 0700) != 0)
    spdlog::warn("{} stays open to other users: {}", path.string(), std::strerror(errno));
}

}  // namespace

void DataFolder::refuse(const std::string& reason) const {
  throw StoreError(StoreError::Kind::unavailable,
                   "the data folder " + folder_.string() + ": " + reason);
}

std::optional<DataFolder::Identity> DataFolder::identity(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return Identity{status.st_dev, status.st_ino};
}

FileDescriptor DataFolder::locked(const fs::path& path, int flags) const {
  FileDescriptor file(::open(path.c_str(), flags | O_CLOEXEC, 0600));
  if (!file) refuse(std::strerror(errno));
  if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) return file;
  if (errno == EWOULDBLOCK) refuse("another translucube serves it");
  // Network file systems lock only what can be written: there the file in the folder serves alone.
  if ((flags & O_DIRECTORY) == 0) refuse(std::strerror(errno));
  return file;
}

DataFolder::DataFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) refuse(error.message());
  folder_lock_ = locked(folder_, O_RDONLY | O_DIRECTORY);
  lock_ = locked(folder_ / "lock", O_RDWR | O_CREAT);
  folder_identity_ = identity(folder_);
  lock_identity_ = identity(folder_ / "lock");
  close_to_others(folder_);
  for (const char* name :
       {"lock", "jobs.sqlite", "jobs.sqlite-wal", "jobs.sqlite-shm", "artifacts", "uploads"})
    close_to_others(folder_ / name);
  // An empty store would know nothing of what lies there.
  const std::uintmax_t bytes = fs::file_size(store_file(), error);
  const bool no_store = error || bytes == 0;
  if (no_store && fs::is_directory(artifacts(), error) && !fs::is_empty(artifacts(), error))
    refuse("the job store " + store_file().filename().string() +
           " is lost or empty, but there are pictures: put it back, or remove them too");
}

void DataFolder::check() const {
  if (identity(folder_) != folder_identity_) refuse("it was removed or replaced");
  if (identity(folder_ / "lock") != lock_identity_) refuse("its lock was removed or replaced");
  const auto store = identity(store_file());
  const std::lock_guard lock(mutex_);
  if (!store_identity_) store_identity_ = store;
  if (!store || store != store_identity_) refuse("its job store was removed or replaced");
}

}  // namespace translucube::server
