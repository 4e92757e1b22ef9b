#include "picture/oiio/codecs.h"

#include <dlfcn.h>

#include <array>
#include <future>

#include "picture/companion.h"

namespace translucube {
namespace {

/// It stays loaded until the process ends.
const ImageCodecs* load() {
  void* const module =
      ::dlopen(companion(TRANSLUCUBE_IMAGE_MODULE).c_str(), RTLD_LAZY | RTLD_LOCAL);
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
