#pragma once

// The films of the renders that are being traced, for those who want to see a picture grow.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "renderer/film/explorable_develop.h"
#include "renderer/film/film.h"
#include "renderer/render.h"

namespace translucube::server {

/// The merged passes of a render so far. Its worker alone changes it, and under the lock; whoever
/// else looks at it holds the lock too.
struct LiveFilm {
  std::mutex mutex;
  std::optional<ExplorableBasis> explorable;  ///< of a film that keeps the path lengths
  Film film;
};

/// Those that a worker has in hand, by job. Safe to share by threads.
class LiveFilms {
 public:
  /// `on_change` is called whenever there is more to see.
  explicit LiveFilms(std::function<void()> on_change = [] {}) : on_change_(std::move(on_change)) {}

  /// Seen as long as it lives, or until the next of this job.
  std::shared_ptr<LiveFilm> add(const std::string& id, std::optional<ExplorableBasis> explorable,
                                Film film);
  void merge(LiveFilm& live, const PassFilm& pass);

  /// nullptr where no worker has the job in hand.
  std::shared_ptr<LiveFilm> find(const std::string& id) const;
  /// Camera samples for each pixel of what there is to see; 0: nothing yet.
  std::uint32_t samples(const std::string& id) const;

 private:
  const std::function<void()> on_change_;
  mutable std::mutex mutex_;
  std::map<std::string, std::weak_ptr<LiveFilm>> films_;
};

}  // namespace translucube::server
