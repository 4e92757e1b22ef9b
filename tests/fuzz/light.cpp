// Pictures of strangers: any bytes are refused or become finite light.

#include <cmath>
#include <span>

#include "picture/light/decode.h"
#include "picture/light_map.h"
#include "tests/fuzz/requests.h"

using namespace translucube;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const Image image = decode_light({reinterpret_cast<const char*>(data), size});
    fuzz::require(image.width > 0 && image.height > 0, "a picture has pixels");
    for (const float value : image.pixels)
      fuzz::require(std::fabs(value) <= brightest, "light is finite and bounded");
  } catch (const ImageError& error) {
    fuzz::require(*error.what() != '\0', "a refusal says why");
  } catch (const std::bad_alloc&) {  // the sandbox bounds it
  }
  return 0;
}
