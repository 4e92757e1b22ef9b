#include "server/worker/task_runner.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <new>

#include "api/request/scene_spec.h"
#include "api/request/sweep.h"
#include "server/worker/accept.h"
#include "server/worker/render_failure.h"
#include "server/worker/task_watch.h"

namespace translucube::server {
namespace {

using api::ProblemCode;

// A disk that refuses is tried again for about two minutes.
constexpr int max_storage_attempts = 8;

const char* pointer_of(SceneError::Part part) {
  switch (part) {
    case SceneError::Part::object:
      return "/scene/object";
    case SceneError::Part::environment:
      return "/scene/environment";
    case SceneError::Part::camera:
      return "/scene/camera";
  }
  return "";
}

}  // namespace

void TaskRunner::run(const Task& task, std::stop_source work) {
  try {
    run_or_throw(task, std::move(work));
    return;
  } catch (const RenderFailure& failure) {
    fail(task, failure.problem);
  } catch (const StoreError& error) {
    retry_later(task, error.what());
  } catch (const FileError& error) {
    retry_later(task, error.what());
  } catch (const SceneError& error) {
    fail(task, {ProblemCode::invalid_request,
                "The scene cannot be built.",
                {{pointer_of(error.part), error.what()}}});
  } catch (const std::bad_alloc&) {
    fail(task,
         {ProblemCode::internal, "There is not enough memory for a render of this size.", {}});
  } catch (const std::exception& error) {
    spdlog::error("render {}: {}", task.job_id, error.what());
    fail(task, {ProblemCode::internal, "The renderer failed on this request.", {}});
  }
  hand_ = {};
}

void TaskRunner::run_or_throw(const Task& task, std::stop_source work) {
  const std::optional<Job> job = workshop_.store.find(task.job_id);
  if (!job || job->state != api::JobState::running) {
    give_back(task);  // canceled or removed between the claim and here
    return;
  }
  const TaskWatch watch(workshop_.store, task, work);
  if (!take_in_hand(task, *job, work.get_token())) return;
  auto outcome = trace_or_read(task, std::move(work));
  if (auto* pass = std::get_if<TracedPass>(&outcome)) {
    if (!accept(workshop_, hand_, task, std::move(*pass))) hand_ = {};
  } else if (const auto* late = std::get_if<OutOfTime>(&outcome)) {
    end_without(workshop_, hand_, task, *late);
    hand_ = {};
  } else {
    give_back(task);
  }
}

/// The job's scene and its film of the passes before the task's. False where it ended the task
/// instead.
bool TaskRunner::take_in_hand(const Task& task, const Job& job, std::stop_token stop) {
  if (hand_.is_at(task)) return true;
  if (hand_.id != task.job_id) {
    put_down();
    // Another job may have made the same pictures since this one was accepted.
    if (workshop_.store.finish_from_results(task)) {
      workshop_.metrics.count_cache_hit();
      workshop_.artifacts.remove_all(task.job_id);
      return false;
    }
    auto traced = traced_job(job, workshop_.store, workshop_.catalog);
    if (!traced) throw RenderFailure(traced.problem());
    hand_.job = *std::move(traced);
    hand_.scene = workshop_.engine(api::scene_spec(hand_.job.requests, workshop_.catalog));
    hand_.id = task.job_id;
  }
  if (catch_up(workshop_, hand_, task.pass, job.progress.seconds, std::move(stop))) return true;
  hand_ = {};
  give_back(task);
  return false;
}

/// A crash may have come between the partial film and its entry in the store: then it is there.
std::variant<TracedPass, OutOfTime, Stopped> TaskRunner::trace_or_read(const Task& task,
                                                                       std::stop_source work) {
  if (auto film = workshop_.artifacts.read_pass(task.job_id, task.pass)) {
    const double seconds = film->cpu_seconds / workshop_.cores();
    return TracedPass{std::move(*film), seconds, true};
  }
  auto outcome = trace(hand_.scene, hand_.job.quality(), task.pass, hand_.seconds,
                       workshop_.threads, std::move(work));
  if (const auto* pass = std::get_if<TracedPass>(&outcome)) {
    const TraceCounters& counters = pass->film.counters;
    workshop_.metrics.count_pass(
        {pass->seconds, counters.camera_samples,
         counters.flights + counters.boundary_events + counters.light_samples,
         counters.nan_samples});
  }
  return outcome;
}

void TaskRunner::give_back(const Task& task) {
  if (!workshop_.store.release(task)) tidy(workshop_, task.job_id);
}

void TaskRunner::fail(const Task& task, const api::Problem& problem) {
  spdlog::error("render {} failed: {}", task.job_id, problem.detail);
  hand_ = {};
  try {
    workshop_.store.fail(task, api::to_json(problem));
    tidy(workshop_, task.job_id);
  } catch (const std::exception& error) {
    // The lease runs out and the task comes again.
    spdlog::error("render {}: {}", task.job_id, error.what());
  }
}

void TaskRunner::retry_later(const Task& task, const std::string& reason) {
  if (task.attempts >= max_storage_attempts) {
    spdlog::error("render {}: {}", task.job_id, reason);
    fail(task, {ProblemCode::storage_failure, "The service could not store the render.", {}});
    return;
  }
  const std::int64_t delay_ms = std::min<std::int64_t>(30'000, 500LL << task.attempts);
  spdlog::warn("render {}: {}; again in {} ms", task.job_id, reason, delay_ms);
  try {
    if (!workshop_.store.release(task, delay_ms, true)) tidy(workshop_, task.job_id);
  } catch (const StoreError& error) {
    spdlog::error("render {}: {}", task.job_id, error.what());
  }
}

}  // namespace translucube::server
