#include "picture/oiio/file.h"

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cstring>
#include <mutex>

#include "picture/file_sink.h"

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

/// Reports success to the codec whatever happens: the sink tells the truth.
class SinkProxy final : public OIIO::Filesystem::IOProxy {
 public:
  SinkProxy(const std::filesystem::path& file, FileSink& sink)
      : IOProxy(file.string(), Write), sink_(sink) {}

  // Not "file": OpenImageIO would take that for its own class and reach for its FILE*.
  const char* proxytype() const override { return "translucube"; }
  bool opened() const override { return sink_.is_open(); }
  std::size_t size() const override { return static_cast<std::size_t>(end_); }

  std::size_t read(void* buffer, std::size_t bytes) override {
    const std::size_t got = sink_.read(static_cast<std::uint64_t>(m_pos), buffer, bytes);
    m_pos += static_cast<std::int64_t>(got);
    return got;
  }
  std::size_t write(const void* buffer, std::size_t bytes) override {
    sink_.write(static_cast<std::uint64_t>(m_pos), buffer, bytes);
    m_pos += static_cast<std::int64_t>(bytes);
    end_ = std::max(end_, m_pos);
    return bytes;
  }

 private:
  FileSink& sink_;
  std::int64_t end_ = 0;
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
  if (!sink.is_open()) fail_image(file, std::strerror(sink.finish()));
  SinkProxy proxy(file, sink);
  auto output = OIIO::ImageOutput::create(std::string(name(format)));
  if (!output || !output->set_ioproxy(&proxy))
    fail_image(file, "this OpenImageIO cannot write " + std::string(name(format)));
  const bool written = output->open(file.string(), spec) && write(*output) && output->close();
  const std::string problem = output->geterror();
  output.reset();  // before the proxy that it writes to
  if (const int error_number = sink.finish()) fail_image(file, std::strerror(error_number));
  if (!written) fail_image(file, "cannot be written (" + problem + ")");
}

}  // namespace translucube
