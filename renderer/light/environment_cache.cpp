#include "renderer/light/environment_cache.h"

#include "picture/light_map.h"

namespace translucube {

std::shared_ptr<const ImageEnvironment> EnvironmentCache::get(const std::filesystem::path& file,
                                                              double rotation_rad, double scale,
                                                              EnvironmentSide side) {
  std::error_code unreadable;  // read_light_map() says it better
  const Key key{file,
                std::filesystem::file_size(file, unreadable),
                std::filesystem::last_write_time(file, unreadable),
                rotation_rad,
                scale,
                side};
  if (auto found = environments_.find(key)) return found;
  // Without the lock: who asks for another environment does not wait, and two who ask for the same
  // one at first both make it.
  const Image image = read_light_map(file);
  auto made = std::make_shared<const ImageEnvironment>(image, rotation_rad, scale, side);
  // What the file held before is never asked for again.
  environments_.forget_if([&](const Key& known) {
    return known.file == file && (known.changed != key.changed || known.bytes != key.bytes);
  });
  environments_.keep(key, made, std::uint64_t(image.width) * std::uint64_t(image.height));
  return made;
}

}  // namespace translucube
