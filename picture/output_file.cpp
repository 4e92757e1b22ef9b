#include "picture/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace translucube {

OutputFile::OutputFile(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) error_number_ = errno;
}

OutputFile::~OutputFile() { finish(); }

void OutputFile::write(const void* bytes, std::size_t count, std::int64_t position) {
  const char* const from = static_cast<const char*>(bytes);
  for (std::size_t done = 0; error_number_ == 0 && done < count;) {
    const ssize_t put = ::pwrite(descriptor_, from + done, count - done,
                                 static_cast<off_t>(position) + static_cast<off_t>(done));
    if (put > 0)
      done += static_cast<std::size_t>(put);
    else if (errno != EINTR)
      error_number_ = put < 0 ? errno : EIO;
  }
}

std::size_t OutputFile::read(void* bytes, std::size_t count, std::int64_t position) const {
  const ssize_t got = ::pread(descriptor_, bytes, count, static_cast<off_t>(position));
  return got > 0 ? static_cast<std::size_t>(got) : 0;
}

int OutputFile::finish() {
  if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_number_ == 0) error_number_ = errno;
  descriptor_ = -1;
  return error_number_;
}

}  // namespace translucube
