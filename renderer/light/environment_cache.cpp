#include "renderer/light/environment_cache.h"

#include <algorithm>

#include "picture/image_io.h"

namespace translucube {

std::shared_ptr<const ImageEnvironment> EnvironmentCache::get(const std::filesystem::path& file,
                                                              double rotation_rad, double scale,
                                                              EnvironmentSide side) {
  std::error_code unreadable;  // read_image() says it better
  const Key key{file,
                std::filesystem::file_size(file, unreadable),
                std::filesystem::last_write_time(file, unreadable),
                rotation_rad,
                scale,
                side};
  if (auto found = find(key)) return found;
  // Without the lock: who asks for another environment does not wait, and two who ask for the same
  // one at first both make it.
  const Image image = read_image(file);
  auto made = std::make_shared<const ImageEnvironment>(image, rotation_rad, scale, side);
  keep({key, std::uint64_t(image.width) * std::uint64_t(image.height), made});
  return made;
}

std::shared_ptr<const ImageEnvironment> EnvironmentCache::find(const Key& key) {
  const std::lock_guard lock(mutex_);
  const auto entry = std::ranges::find(entries_, key, &Entry::key);
  if (entry == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, entry);
  return entry->environment;
}

void EnvironmentCache::keep(Entry entry) {
  const std::lock_guard lock(mutex_);
  // What the file held before, too.
  std::erase_if(entries_, [&](const Entry& e) {
    return e.key == entry.key ||
           (e.key.file == entry.key.file &&
            (e.key.changed != entry.key.changed || e.key.bytes != entry.key.bytes));
  });
  entries_.push_front(std::move(entry));
  std::uint64_t pixels = 0;
  for (const Entry& e : entries_) pixels += e.pixels;
  while (pixels > most_pixels && entries_.size() > 1) {
    pixels -= entries_.back().pixels;
    entries_.pop_back();
  }
}

}  // namespace translucube
