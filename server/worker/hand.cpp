#include "server/worker/hand.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

namespace translucube::server {
namespace {

constexpr double seconds_between_checkpoints = 2;
// The checkpoints of large films take time too: this many times as long is traced between them.
constexpr double tracing_to_writing = 10;

/// The film of the passes before this one, where another worker has it in hand just now.
std::optional<Film> film_in_memory(const Workshop& workshop, const std::string& id,
                                   const Pass& pass) {
  const auto live = workshop.live_films.find(id);
  if (!live) return std::nullopt;
  const std::lock_guard lock(live->mutex);
  return live->film.passes == pass.index ? std::optional(live->film) : std::nullopt;
}

/// A pass that was merged before, but is lost of the film.
std::optional<PassFilm> pass_again(Workshop& workshop, const Hand& hand, const Pass& pass,
                                   std::stop_token stop) {
  if (auto film = workshop.artifacts.read_pass(hand.id, pass)) return film;
  spdlog::warn("render {}: pass {} is traced again", hand.id, pass.index);
  auto film = hand.scene.trace(pass, workshop.threads, std::move(stop));
  if (film) workshop.artifacts.write_pass(hand.id, *film);
  return film;
}

}  // namespace

bool catch_up(Workshop& workshop, Hand& hand, const Pass& pass, double seconds,
              std::stop_token stop) {
  std::optional<Film> in_memory = film_in_memory(workshop, hand.id, pass);
  Film film = in_memory ? std::move(*in_memory) : workshop.artifacts.read_film(hand.id, pass.index);
  hand.unsaved_from = in_memory ? 0 : pass.index;
  hand.seconds = hand.seconds_at_checkpoint = seconds;
  while (film.passes < pass.index) {
    const std::optional<Pass> lost = hand.job.pass(film.passes);
    const auto found = lost ? pass_again(workshop, hand, *lost, stop) : std::nullopt;
    if (!found) return false;
    merge(film, *found);
  }
  hand.live = workshop.live_films.add(hand.id, hand.scene.explorable, std::move(film));
  return true;
}

void keep_checkpoint(Workshop& workshop, Hand& hand) {
  if (hand.seconds - hand.seconds_at_checkpoint <
      std::max(seconds_between_checkpoints, hand.least_between_checkpoints))
    return;
  const auto start = std::chrono::steady_clock::now();
  workshop.artifacts.write_film(hand.id, hand.film());
  workshop.artifacts.remove_films_before(hand.id, hand.film().passes);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  hand.least_between_checkpoints = tracing_to_writing * took.count();
  hand.seconds_at_checkpoint = hand.seconds;
  hand.unsaved_from = hand.film().passes;
}

void put_down(Workshop& workshop, Hand& hand) {
  try {
    const bool unsaved = hand.film().shares && hand.unsaved_from < hand.film().passes;
    const std::optional<Job> job = unsaved ? workshop.store.find(hand.id) : std::nullopt;
    if (job && !api::is_end(job->state)) workshop.artifacts.write_film(hand.id, hand.film());
  } catch (const std::exception& error) {
    spdlog::warn("render {}: {}", hand.id, error.what());  // it is traced again
  }
  if (!hand.id.empty()) tidy(workshop, hand.id);  // it may have ended while that was written
  hand = {};
}

}  // namespace translucube::server
