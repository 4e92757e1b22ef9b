#include "server/worker/trace.h"

#include <chrono>
#include <limits>

#include "renderer/base/deadline.h"

namespace translucube::server {

std::variant<TracedPass, OutOfTime, Stopped> trace(const TracedScene& scene, const Quality& quality,
                                                   const Pass& pass, double seconds_before,
                                                   int threads, std::stop_source work) {
  using Clock = Patience::Clock;
  const auto start = Clock::now();
  double time_left = std::numeric_limits<double>::infinity();
  std::optional<Deadline> deadline;
  Patience patience(work.get_token());
  if (const auto* target = std::get_if<TimeTarget>(&quality); target && pass.index == 0) {
    // Of the first pass is kept what comes in time: a picture of nothing is of no use.
    patience.deadline = deadline_of(*target, start);
  } else if (target) {
    time_left = target->seconds - seconds_before;
    deadline.emplace(work, time_left);
  }
  std::optional<PassFilm> film = scene.trace(pass, threads, patience);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (film) return TracedPass{std::move(*film), seconds};
  if (seconds >= time_left) return OutOfTime{seconds};
  return Stopped{};
}

}  // namespace translucube::server
