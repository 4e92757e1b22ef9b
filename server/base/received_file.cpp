#include "server/base/received_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "server/base/ids.h"

namespace translucube::server {

ReceivedFile::ReceivedFile(const std::filesystem::path& folder, std::uint64_t limit)
    : limit_(limit),
      path_(temporary_path(folder)),
      file_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)) {
  if (!file_) fail(path_, "create", errno);
}

ReceivedFile::~ReceivedFile() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove(path_, ignored);
}

void ReceivedFile::append(std::string_view bytes) {
  write_bytes(file_, path_, bytes);
  sum_.add(bytes);
  size_ += bytes.size();
}

void ReceivedFile::sync() {
  if (::fsync(file_.get()) != 0) fail(path_, "make durable", errno);
}

void ReceivedFile::keep(const std::filesystem::path& as) {
  if (::rename(path_.c_str(), as.c_str()) != 0) fail(as, "name", errno);
  path_.clear();
  sync_folder(as.parent_path());
}

}  // namespace translucube::server
