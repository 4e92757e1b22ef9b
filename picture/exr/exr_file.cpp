#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "picture/exr/exr.h"
#include "picture/image_io_rules.h"
#include "picture/version.h"

namespace translucube {
namespace {

/// Writes to a file through a small buffer and remembers the first error: OpenEXR writes its last
/// bytes in a destructor, which tells nobody. finish() does.
class FileSink final : public Imf::OStream {
 public:
  explicit FileSink(const std::filesystem::path& file)
      : OStream(file.c_str()),
        descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) error_number_ = errno;
  }
  ~FileSink() override { finish(); }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  void write(const char bytes[], int count) override {
    buffer_.append(bytes, static_cast<std::size_t>(count));
    if (buffer_.size() >= most_buffered) flush();
  }
  std::uint64_t tellp() override { return start_ + buffer_.size(); }
  void seekp(std::uint64_t position) override {
    flush();
    start_ = position;
  }

  /// 0 if every byte was handed to the system, else the errno of the first failure.
  int finish() {
    flush();
    if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_number_ == 0) error_number_ = errno;
    descriptor_ = -1;
    return error_number_;
  }

 private:
  static constexpr std::size_t most_buffered = 1 << 16;

  void flush() {
    for (std::size_t done = 0; error_number_ == 0 && done < buffer_.size();) {
      const ssize_t put = ::pwrite(descriptor_, buffer_.data() + done, buffer_.size() - done,
                                   static_cast<off_t>(start_ + done));
      if (put > 0)
        done += static_cast<std::size_t>(put);
      else if (errno != EINTR)
        error_number_ = put < 0 ? errno : EIO;
    }
    start_ += buffer_.size();
    buffer_.clear();
  }

  int descriptor_;
  std::uint64_t start_ = 0;  ///< of the buffer in the file
  std::string buffer_;
  int error_number_ = 0;
};

void check_header(const std::filesystem::path& file, const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type()))
    fail_image(file, "a deep or volume image, not a flat one");
  const Imath::Box2i& window = header.dataWindow();
  check_size(file, std::int64_t{window.max.x} - window.min.x + 1,
             std::int64_t{window.max.y} - window.min.y + 1);
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
      fail_image(file, "has subsampled channels");
}

}  // namespace

bool is_exr(const std::filesystem::path& file) {
  constexpr std::array<char, 4> magic = {0x76, 0x2f, 0x31, 0x01};
  std::array<char, 4> start{};
  std::ifstream in(file, std::ios::binary);
  return in.read(start.data(), start.size()) && start == magic;
}

void read_exr_file(const std::filesystem::path& file,
                   const std::function<void(Imf::InputFile&)>& read) {
  try {
    // No threads of its own: they belong to the renders.
    Imf::InputFile input(file.c_str(), 0);
    check_header(file, input.header());
    read(input);
  } catch (const ImageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    fail_image(file, std::string("not a readable image (") + error.what() + ")");
  }
}

Imf::Header exr_header(int width, int height, Imf::Compression compression) {
  Imf::Header header(width, height);
  header.compression() = compression;
  header.insert("Software", Imf::StringAttribute("Translucube " + std::string(project_version())));
  return header;
}

void write_exr_file(const std::filesystem::path& file, const Imf::Header& header,
                    const std::function<void(Imf::OutputFile&)>& write) {
  FileSink sink(file);
  std::string problem;
  try {
    Imf::OutputFile output(sink, header, 0);
    write(output);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (const int error_number = sink.finish()) fail_image(file, std::strerror(error_number));
  if (!problem.empty()) fail_image(file, "cannot be written (" + problem + ")");
}

std::string text_attribute(const Imf::Header& header, const std::string& name) {
  const auto* found = header.findTypedAttribute<Imf::StringAttribute>(name);
  return found ? found->value() : std::string();
}

}  // namespace translucube
