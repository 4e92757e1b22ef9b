// What a worker has in hand: the scene and the merged film of its last job.

#include <spdlog/spdlog.h>

#include <chrono>

#include "api/request/scene_spec.h"
#include "api/request/sweep.h"
#include "server/worker/render_task.h"

namespace translucube::server {

// The checkpoints of large films take time too: this many times as long is traced between them.
constexpr double tracing_to_writing = 10;

void TaskRunner::forget() { hand_ = {}; }

void TaskRunner::put_down() {
  try {
    const bool unsaved = hand_.film().shares && hand_.unsaved_from < hand_.film().passes;
    const std::optional<Job> job = unsaved ? workshop_.store.find(hand_.id) : std::nullopt;
    if (job && !api::is_end(job->state)) workshop_.artifacts.write_film(hand_.id, hand_.film());
  } catch (const std::runtime_error& error) {
    spdlog::warn("render {}: {}", hand_.id, error.what());  // it is traced again
  }
  forget();
}

void TaskRunner::keep_checkpoint() {
  const auto start = std::chrono::steady_clock::now();
  workshop_.artifacts.write_film(hand_.id, hand_.film());
  workshop_.artifacts.remove_films_before(hand_.id, hand_.film().passes);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  hand_.least_between_checkpoints = tracing_to_writing * took.count();
  hand_.seconds_at_checkpoint = hand_.seconds;
  hand_.unsaved_from = hand_.film().passes;
}

/// The merged film of the passes before the task's, where another worker has it in hand just now.
std::optional<Film> TaskRunner::live_film(const Task& task) const {
  const auto live = workshop_.live_films.find(task.job_id);
  if (!live) return std::nullopt;
  const std::lock_guard lock(live->mutex);
  return live->film.passes == task.pass.index ? std::optional(live->film) : std::nullopt;
}

/// Makes the job's scene and its merged film of the passes before the task's. False where it ended
/// the task instead.
bool TaskRunner::take_in_hand(const Task& task, const Job& job, std::stop_token stop) {
  if (hand_.id == task.job_id && hand_.film().passes == task.pass.index) return true;
  if (hand_.id != task.job_id) {
    put_down();
    // Another job may have made the same pictures since this one was accepted.
    if (workshop_.store.finish_from_results(task)) {
      workshop_.metrics.count_cache_hit();
      workshop_.artifacts.remove_all(task.job_id);
      return false;
    }
    auto traced = traced_job(job, workshop_.store, workshop_.catalog);
    if (!traced) {
      fail(task, traced.problem());
      return false;
    }
    hand_.job = *std::move(traced);
    hand_.scene = workshop_.engine.build(api::scene_spec(hand_.job.requests, workshop_.catalog));
    hand_.id = task.job_id;
  }
  std::optional<Film> in_memory = live_film(task);
  hand_.unsaved_from = in_memory ? 0 : task.pass.index;
  Film film = in_memory ? std::move(*in_memory)
                        : workshop_.artifacts.read_film(task.job_id, task.pass.index);
  hand_.seconds = job.progress.seconds;
  hand_.seconds_at_checkpoint = hand_.seconds;
  // A checkpoint lost to a broken disk costs time, not the render.
  while (film.passes < task.pass.index) {
    const std::optional<Pass> lost = plan_pass(film.passes, hand_.job.pixels(), total_samples());
    std::optional<PassFilm> pass;
    if (lost) pass = workshop_.artifacts.read_pass(task.job_id, *lost);
    if (lost && !pass) {
      spdlog::warn("render {}: pass {} is traced again", task.job_id, lost->index);
      pass = workshop_.engine.trace(*hand_.scene, *lost, workshop_.threads, stop);
    }
    if (!pass) {
      forget();
      workshop_.store.release(task);
      return false;
    }
    workshop_.artifacts.write_pass(task.job_id, *pass);
    if (film.passes == 0) film = Film(pass->width, pass->height, pass->lanes, pass->shares);
    merge(film, *pass);
  }
  hand_.live = workshop_.live_films.add(task.job_id, hand_.scene, std::move(film));
  return true;
}

}  // namespace translucube::server
