#include "picture/light_map.h"

#include <cmath>

#include "picture/image_io_rules.h"
#include "picture/sandbox/answer.h"
#include "picture/sandbox/sandbox.h"

namespace translucube {
namespace {

/// Width, height and pixels, as the reader's process writes them (renderer/reader).
Image unpack_light(std::span<const std::byte> bytes, const std::filesystem::path& file) {
  AnswerReader reader(bytes);
  const auto width = reader.value<std::int32_t>(), height = reader.value<std::int32_t>();
  check_size(file, width, height);
  if (reader.remains() != sizeof(float) * 3 * std::size_t(width) * height)
    throw AnswerError("an answer of another size");
  Image image(width, height);
  reader.values(std::span(image.pixels));
  for (const float value : image.pixels)
    if (!(std::fabs(value) <= brightest)) throw AnswerError("an answer that is not light");
  return image;
}

}  // namespace

Image read_light_map(const std::filesystem::path& file) {
  try {
    const SandboxAnswer answer = read_in_sandbox("light", file);
    return unpack_light(open_answer(answer.bytes()), file);
  } catch (const FileRefused& error) {
    fail_image(file, error.what());
  } catch (const FileUnavailable& error) {
    throw ImageUnavailable(file.string() + ": " + error.what());
  } catch (const AnswerError& error) {
    fail_image(file, std::string("its reader gave ") + error.what());
  }
}

}  // namespace translucube
