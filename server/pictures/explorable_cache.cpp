#include "server/pictures/explorable_cache.h"

#include <algorithm>

namespace translucube::server {
namespace {

std::uint64_t bytes_of(const ExplorableFilm& film) {
  return film.halves.size() * sizeof film.halves[0];
}

}  // namespace

ExplorableCache::Shared ExplorableCache::find(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(entries_, name, &Entry::name);
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return found->film;
}

void ExplorableCache::keep(const std::string& name, Shared film) {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [&](const Entry& entry) { return entry.name == name; });
  entries_.push_front({name, std::move(film)});
  std::uint64_t bytes = 0;
  std::erase_if(entries_, [&](const Entry& entry) {
    bytes += bytes_of(*entry.film);
    return bytes > most_bytes_ && &entry != &entries_.front();
  });
}

ExplorableCache::Shared ExplorableCache::get(const std::string& name,
                                             const std::function<ExplorableFilm()>& read) {
  if (Shared known = find(name)) return known;
  auto film = std::make_shared<const ExplorableFilm>(read());
  keep(name, film);
  return film;
}

}  // namespace translucube::server
