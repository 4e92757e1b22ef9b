#include "picture/oiio/file.h"

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <cstring>
#include <mutex>

#include "picture/output_file.h"

namespace translucube {
namespace {

/// A file as OpenImageIO's codecs write it: one place after the other, but for those that they turn
/// back to.
class FileProxy final : public OIIO::Filesystem::IOProxy {
 public:
  FileProxy(const std::filesystem::path& name, OutputFile& file)
      : IOProxy(name.string(), Write), file_(file) {}

  // Not "file": OpenImageIO would take that for its own class and reach for its FILE*.
  const char* proxytype() const override { return "translucube"; }
  bool opened() const override { return file_.is_open(); }
  std::size_t size() const override { return static_cast<std::size_t>(end_); }

  std::size_t read(void* buffer, std::size_t bytes) override {
    const std::size_t got = file_.read(buffer, bytes, m_pos);
    m_pos += static_cast<std::int64_t>(got);
    return got;
  }
  std::size_t write(const void* buffer, std::size_t bytes) override {
    file_.write(buffer, bytes, m_pos);
    m_pos += static_cast<std::int64_t>(bytes);
    end_ = std::max(end_, m_pos);
    return bytes;
  }

 private:
  OutputFile& file_;
  std::int64_t end_ = 0;
};

}  // namespace

void use_one_thread() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", 1);
  });
}

std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path& file) {
  use_one_thread();
  // OpenImageIO has readers that need no file (names that end in ".null"): ask for a real one.
  check_regular_file(file);
  if (auto input = OIIO::ImageInput::open(file.string())) return input;
  const std::string problem = OIIO::geterror();
  // A stored artifact or a download may have no extension to go by.
  for (const ImageFormatRow& row : image_formats) {
    if (row.library != ImageLibrary::open_image_io) continue;
    auto input = OIIO::ImageInput::create(std::string(row.name));
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
  OutputFile sink(file);
  if (!sink.is_open()) fail_image(file, std::strerror(sink.finish()));
  FileProxy proxy(file, sink);
  auto output = OIIO::ImageOutput::create(std::string(name(format)));
  if (!output || !output->set_ioproxy(&proxy))
    fail_image(file, "this OpenImageIO cannot write " + std::string(name(format)));
  const bool written = output->open(file.string(), spec) && write(*output) && output->close();
  const std::string problem = output->geterror();
  output.reset();  // before what it writes to
  if (const int error_number = sink.finish()) fail_image(file, std::strerror(error_number));
  if (!written) fail_image(file, "cannot be written (" + problem + ")");
}

}  // namespace translucube
