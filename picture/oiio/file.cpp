#include "picture/oiio/file.h"

#include <OpenImageIO/filesystem.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>

namespace translucube {
namespace {

/// The threads belong to the renders: OpenImageIO and OpenEXR decode on the calling one.
void use_one_thread() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", 1);
  });
}

/// Writes to a file and remembers the first error. It reports success to the codec whatever
/// happens, because libjpeg answers a failed write with exit(); finish() tells the truth.
class FileSink final : public OIIO::Filesystem::IOProxy {
 public:
  explicit FileSink(const std::filesystem::path& file)
      : IOProxy(file.string(), Write),
        descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) error_number_ = errno;
  }
  ~FileSink() override { finish(); }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  // Not "file": OpenImageIO would take that for its own class and reach for its FILE*.
  const char* proxytype() const override { return "translucube"; }
  bool opened() const override { return descriptor_ >= 0; }
  std::size_t size() const override { return static_cast<std::size_t>(end_); }

  std::size_t read(void* buffer, std::size_t bytes) override {
    const ssize_t got = ::pread(descriptor_, buffer, bytes, m_pos);
    if (got > 0) m_pos += got;
    return got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  std::size_t write(const void* buffer, std::size_t bytes) override {
    const char* from = static_cast<const char*>(buffer);
    for (std::size_t done = 0; error_number_ == 0 && done < bytes;) {
      const ssize_t put =
          ::pwrite(descriptor_, from + done, bytes - done, m_pos + static_cast<off_t>(done));
      if (put > 0)
        done += static_cast<std::size_t>(put);
      else if (errno != EINTR)
        error_number_ = put < 0 ? errno : EIO;
    }
    m_pos += static_cast<std::int64_t>(bytes);
    end_ = std::max(end_, m_pos);
    return bytes;
  }

  /// 0 if every byte was handed to the system, else the errno of the first failure.
  int finish() {
    if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_number_ == 0) error_number_ = errno;
    descriptor_ = -1;
    return error_number_;
  }

 private:
  int descriptor_;
  std::int64_t end_ = 0;
  int error_number_ = 0;
};

}  // namespace

std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path& file) {
  use_one_thread();
  // OpenImageIO has readers that need no file (names that end in ".null"): ask for a real one.
  check_regular_file(file);
  if (auto input = OIIO::ImageInput::open(file.string())) return input;
  const std::string problem = OIIO::geterror();
  // A stored artifact or a download may have no extension to go by.
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::tiff, ImageFormat::jpeg}) {
    auto input = OIIO::ImageInput::create(std::string(name(format)));
    OIIO::ImageSpec spec;
    if (input && input->open(file.string(), spec)) return input;
  }
  OIIO::geterror();  // of the attempts: the first one is worth telling
  fail_image(file, "not a readable image (" + problem + ")");
}

void write_image_file(const std::filesystem::path& file, ImageFormat format,
                      const OIIO::ImageSpec& spec,
                      const std::function<bool(OIIO::ImageOutput&)>& write) {
  use_one_thread();
  FileSink sink(file);
  if (!sink.opened()) fail_image(file, std::strerror(sink.finish()));
  auto output = OIIO::ImageOutput::create(std::string(name(format)));
  if (!output || !output->set_ioproxy(&sink))
    fail_image(file, "this OpenImageIO cannot write " + std::string(name(format)));
  const bool written = output->open(file.string(), spec) && write(*output) && output->close();
  const std::string problem = output->geterror();
  output.reset();  // before the sink that it writes to
  if (const int error_number = sink.finish()) fail_image(file, std::strerror(error_number));
  if (!written) fail_image(file, "cannot be written (" + problem + ")");
}

}  // namespace translucube
