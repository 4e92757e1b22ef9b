#include "server/pictures/live_films.h"

namespace translucube::server {

std::shared_ptr<LiveFilm> LiveFilms::add(const std::string& id,
                                         std::optional<ExplorableBasis> explorable, Film film) {
  auto live = std::make_shared<LiveFilm>();
  live->explorable = std::move(explorable);
  live->film = std::move(film);
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(films_, [](const auto& entry) { return entry.second.expired(); });
    films_[id] = live;
  }
  if (live->film.samples > 0) on_change_();
  return live;
}

void LiveFilms::merge(LiveFilm& live, const PassFilm& pass) {
  {
    const std::lock_guard lock(live.mutex);
    translucube::merge(live.film, pass);
  }
  on_change_();
}

std::shared_ptr<LiveFilm> LiveFilms::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = films_.find(id);
  return found == films_.end() ? nullptr : found->second.lock();
}

std::uint32_t LiveFilms::samples(const std::string& id) const {
  const auto live = find(id);
  if (!live) return 0;
  const std::lock_guard lock(live->mutex);
  return live->film.samples;
}

}  // namespace translucube::server
