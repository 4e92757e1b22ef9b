#include "server/worker/accept.h"

#include "api/answer/render_status.h"
#include "server/worker/render_failure.h"
#include "server/worker/results.h"

namespace translucube::server {
namespace {

// A pass that took this long [s] is kept whatever comes next.
constexpr double costly_pass = 2;

void keep(Workshop& workshop, const Hand& hand, TracedPass& pass) {
  if (pass.on_disk) return;
  workshop.artifacts.write_pass(hand.id, pass.film);
  pass.on_disk = true;
}

void refuse_if_not_finite(const Film& film) {
  if (film.counters.nan_samples == 0) return;
  throw RenderFailure({api::ProblemCode::internal,
                       "The renderer made " + std::to_string(film.counters.nan_samples) +
                           " samples that are not finite: a bug, please report this request.",
                       {}});
}

/// `seconds`: wall clock of the tracing until now; `pass_seconds`: of the task's pass, if it is in
/// the film.
void end(Workshop& workshop, const Hand& hand, const Task& task, double seconds,
         std::optional<double> pass_seconds) {
  const std::string stats =
      api::stats_json(hand.scene.stats(hand.film(), seconds, workshop.cores()));
  const std::vector<StoredResult> results = write_results(workshop, hand, task, stats);
  const Completion completion{pass_seconds, progress_of(hand.film(), hand.job.quality(), seconds)};
  const bool ended = workshop.store.finish(task, completion, stats, results);
  discard_refused(workshop, results);
  if (!ended) return;
  workshop.metrics.count_render(seconds);
  workshop.metrics.count_traced_image();
  for (std::size_t lane = 0; lane < results.size(); ++lane)
    workshop.metrics.count_developed_image();
}

}  // namespace

bool accept(Workshop& workshop, Hand& hand, const Task& task, TracedPass pass) {
  if (pass.seconds > costly_pass) keep(workshop, hand, pass);
  workshop.live_films.merge(*hand.live, pass.film);
  refuse_if_not_finite(hand.film());
  const double seconds = hand.seconds + pass.seconds;
  const std::optional<Pass> next = hand.job.pass(hand.film().passes);
  if (!next || meets(hand.job.quality(), hand.film(), seconds)) {
    pass.film = {};  // the pictures take its place in memory
    end(workshop, hand, task, seconds, pass.seconds);
    return false;
  }
  // An explorable film is written when it is put down, or with a checkpoint: that takes longer than
  // a short pass.
  if (!hand.film().shares) keep(workshop, hand, pass);
  const Completion completion{pass.seconds, progress_of(hand.film(), hand.job.quality(), seconds)};
  if (!workshop.store.complete(task, completion, *next)) return false;
  hand.seconds = seconds;
  keep_checkpoint(workshop, hand);
  return true;
}

void end_without(Workshop& workshop, Hand& hand, const Task& task, OutOfTime pass) {
  end(workshop, hand, task, hand.seconds + pass.seconds, std::nullopt);
}

}  // namespace translucube::server
