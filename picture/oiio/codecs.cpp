#include "picture/oiio/codecs.h"

#include <dlfcn.h>

#include <array>
#include <future>

namespace translucube {
namespace {

namespace fs = std::filesystem;

/// The module lies beside the program where it was built, and in ../lib/translucube where it is
/// installed.
fs::path module_file() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  const char* const file = TRANSLUCUBE_IMAGE_MODULE;
  const fs::path installed = folder / "../lib/translucube" / file;
  return fs::exists(installed, error) ? installed : folder / file;
}

/// It stays loaded until the process ends.
const ImageCodecs* load() {
  void* const module = ::dlopen(module_file().c_str(), RTLD_LAZY | RTLD_LOCAL);
  const void* const codecs = module ? ::dlsym(module, image_codecs_symbol) : nullptr;
  if (!codecs) throw ImageError(std::string("images other than EXR need a module: ") + ::dlerror());
  return static_cast<const ImageCodecs*>(codecs);
}

}  // namespace

const ImageCodecs& image_codecs() {
  static const ImageCodecs* const codecs = load();
  return *codecs;
}

namespace {

std::future<void>& loading() {
  static std::future<void> thread;
  return thread;
}

}  // namespace

void prepare_image_codecs() {
  if (loading().valid()) return;
  loading() = std::async(std::launch::async, [] {
    try {
      image_codecs();
    } catch (const ImageError&) {
      // Whoever needs a codec tries again and is told.
    }
  });
}

void finish_image_codecs() {
  if (loading().valid()) loading().wait();
}

}  // namespace translucube
