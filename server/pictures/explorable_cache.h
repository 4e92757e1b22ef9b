#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "renderer/film/explorable.h"

namespace translucube::server {

/// Explorable films in memory, for those who move along the absorption axis: to read one from the
/// disk takes longer than to develop it. Those used last are kept. Safe to share by threads.
class ExplorableCache {
 public:
  using Shared = std::shared_ptr<const ExplorableFilm>;

  /// `most_bytes`: of all that is kept, the last one apart.
  explicit ExplorableCache(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  /// The film of this name, from memory or by `read`, whose exceptions pass.
  Shared get(const std::string& name, const std::function<ExplorableFilm()>& read);
  void keep(const std::string& name, Shared film);

 private:
  struct Entry {
    std::string name;
    Shared film;
  };
  Shared find(const std::string& name);

  const std::uint64_t most_bytes_;
  std::mutex mutex_;
  std::list<Entry> entries_;  ///< the latest first
};

}  // namespace translucube::server
