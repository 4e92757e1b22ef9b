#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "renderer/base/recently_used.h"
#include "renderer/film/explorable.h"

namespace translucube::server {

/// Explorable films in memory, for those who move along the absorption axis: to read one from the
/// disk takes longer than to develop it. Safe to share by threads.
class ExplorableCache {
 public:
  using Shared = std::shared_ptr<const ExplorableFilm>;

  /// `most_bytes`: of all that is kept, the last one apart.
  explicit ExplorableCache(std::uint64_t most_bytes) : films_(most_bytes) {}

  /// The film of this name, from memory or by `read`, whose exceptions pass.
  Shared get(const std::string& name, const std::function<ExplorableFilm()>& read) {
    if (Shared known = films_.find(name)) return known;
    auto film = std::make_shared<const ExplorableFilm>(read());
    keep(name, film);
    return film;
  }
  void keep(const std::string& name, const Shared& film) {
    films_.keep(name, film, film->halves.size() * sizeof film->halves[0]);
  }

 private:
  RecentlyUsed<std::string, ExplorableFilm> films_;
};

}  // namespace translucube::server
