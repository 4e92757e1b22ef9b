#include "server/store/data_folder.h"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>

#include "server/store/store_error.h"

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
  // An empty store would take all that lies there for rubbish.
  const std::uintmax_t bytes = std::filesystem::file_size(store_file(), error);
  const bool no_store = error || bytes == 0;
  if (no_store && std::filesystem::is_directory(artifacts(), error) &&
      !std::filesystem::is_empty(artifacts(), error))
    refuse("the job store " + store_file().filename().string() +
           " is lost or empty, but there are pictures: put it back, or remove them too");
}

}  // namespace translucube::server
