#include "picture/exr/file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cstring>

#include "picture/output_file.h"
#include "picture/version.h"

namespace translucube {
namespace {

/// Gathers what OpenEXR writes in a small buffer.
class BufferedFile final : public Imf::OStream {
 public:
  BufferedFile(const std::filesystem::path& name, OutputFile& file)
      : OStream(name.c_str()), file_(file) {}

  void write(const char bytes[], int count) override {
    buffer_.append(bytes, static_cast<std::size_t>(count));
    if (buffer_.size() >= most_buffered) flush();
  }
  std::uint64_t tellp() override { return start_ + buffer_.size(); }
  void seekp(std::uint64_t position) override {
    flush();
    start_ = position;
  }
  void flush() {
    file_.write(buffer_.data(), buffer_.size(), static_cast<std::int64_t>(start_));
    start_ += buffer_.size();
    buffer_.clear();
  }

 private:
  static constexpr std::size_t most_buffered = 1 << 16;

  OutputFile& file_;
  std::uint64_t start_ = 0;  ///< of the buffer in the file
  std::string buffer_;
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
  OutputFile sink(file);
  BufferedFile stream(file, sink);
  std::string problem;
  try {
    {
      Imf::OutputFile output(stream, header, 0);
      write(output);
    }
    stream.flush();
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
