#include "server/data_folder.h"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>

#include "server/job_store.h"

namespace translucube::server {

DataFolder::DataFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  const auto refuse = [&](const std::string& reason) {
    throw StoreError(StoreError::Kind::unavailable,
                     "the data folder " + folder_.string() + ": " + reason);
  };
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) refuse(error.message());
  lock_ = FileDescriptor(::open((folder_ / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (!lock_) refuse(std::strerror(errno));
  if (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0)
    refuse(errno == EWOULDBLOCK ? "another translucube serves it" : std::strerror(errno));
}

}  // namespace translucube::server
