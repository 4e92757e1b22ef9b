#include "server/worker/task_runner.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <system_error>

#include "api/request/scene_spec.h"
#include "api/request/sweep.h"
#include "server/store/needs.h"
#include "server/worker/accept.h"
#include "server/worker/render_failure.h"
#include "server/worker/resources.h"
#include "server/worker/task_watch.h"

namespace translucube::server {
namespace {

using api::ProblemCode;

// What is refused so often in a row, though its file can be read, or though a share of the memory
// was free for it, is refused for good.
constexpr int most_refusals = 3, most_without_memory = 5;
constexpr std::int64_t longest_wait_ms = 30'000;

constexpr std::int64_t wait_for_memory_ms = 300;

constexpr const char* disk_refuses = "The disk of the service is full or cannot be used.";

std::chrono::milliseconds wait_after(int attempts, std::int64_t at_first_ms) {
  return std::chrono::milliseconds(
      std::min(longest_wait_ms, at_first_ms << std::clamp(attempts, 0, 8)));
}

const char* pointer_of(SceneError::Part part) {
  switch (part) {
    case SceneError::Part::object:
      return "/scene/object";
    case SceneError::Part::environment:
      return "/scene/environment";
    case SceneError::Part::lights:
      return "/scene/lights";
    case SceneError::Part::ground:
      return "/scene/ground";
    case SceneError::Part::camera:
      return "/scene/camera";
  }
  return "";
}

}  // namespace

void TaskRunner::run(const Task& task, std::stop_source work) {
  try {
    try {
      run_or_throw(task, std::move(work));
      workshop_.setbacks.clear(task.job_id);
    } catch (...) {
      settle(task);
    }
  } catch (const std::exception& error) {
    // The lease runs out and the task comes again.
    spdlog::error("render {}: {}", task.job_id, error.what());
    hand_ = {};
  }
  tidy(workshop_, task.job_id);
}

/// What becomes of a task by the exception at hand.
void TaskRunner::settle(const Task& task) {
  const std::vector<api::RenderRequest> requests = std::move(hand_.job.requests);
  hand_ = {};
  try {
    throw;
  } catch (const RenderFailure& failure) {
    fail(task, failure.problem);
  } catch (const Setback& setback) {
    wait(task, setback);
  } catch (const StoreError& error) {
    wait(task, {Setback::Of::disk, disk_refuses, error.what()});
  } catch (const FileError& error) {
    wait(task, {Setback::Of::disk, disk_refuses, error.what()});
  } catch (const SceneError& error) {
    if (requests.empty()) throw;
    refuse(task, requests.front(), error);
  } catch (const std::bad_alloc& error) {
    if (!wait(task, {Setback::Of::service, "There is too little memory.", error.what()},
              most_without_memory))
      fail(task,
           {ProblemCode::internal, "There is not enough memory for a render of this size.", {}});
  } catch (const std::system_error& error) {
    wait(task, {Setback::Of::service, "The machine has no more threads, or files.", error.what()});
  } catch (const std::exception& error) {
    spdlog::error("render {}: {}", task.job_id, error.what());
    fail(task, {ProblemCode::internal, "The renderer failed on this request.", {}});
  }
}

/// A scene that cannot be built. What its files lack is found when it is submitted: a file that
/// cannot be read now was there then, and will be again.
void TaskRunner::refuse(const Task& task, const api::RenderRequest& request,
                        const SceneError& error) {
  const auto resource = resource_of(request, workshop_.catalog, error.part);
  if (resource) {
    const bool readable =
        resource->of == Setback::Of::request && !error.unavailable && can_be_read(resource->file);
    if (wait(task, {resource->of, "A file that a render needs cannot be read.", error.what()},
             readable ? most_refusals : any_number))
      return;
  }
  const std::string detail = resource ? without_path(error.what(), resource->file) : error.what();
  fail(task, {ProblemCode::invalid_request,
              "The scene cannot be built.",
              {{pointer_of(error.part), detail}}});
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
      return false;
    }
    auto traced = traced_job(job, workshop_.store, workshop_.catalog);
    if (!traced && is_of_resources(traced.problem()))
      throw Setback(Setback::Of::request, "A file that a render names is away.",
                    to_text(traced.problem()));
    if (!traced) throw RenderFailure(traced.problem());
    hand_.memory = workshop_.memory.take(
        task.job_id, memory_of(traced->requests.front(), traced->requests.size()));
    if (!hand_.memory) {
      workshop_.store.release(task, wait_for_memory_ms);
      return false;
    }
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

void TaskRunner::give_back(const Task& task) { workshop_.store.release(task); }

void TaskRunner::fail(const Task& task, const api::Problem& problem) {
  spdlog::error("render {} failed: {}", task.job_id, problem.detail);
  workshop_.setbacks.clear(task.job_id);
  workshop_.store.fail(task, api::to_json(problem));
}

/// The task comes again after a while, which grows with each time; false where it has come so often
/// in a row.
bool TaskRunner::wait(const Task& task, const Setback& setback, int most) {
  const auto delay = wait_after(task.attempts, workshop_.retry_ms);
  const int times = workshop_.setbacks.add(task.job_id, setback, delay);
  if (times >= most) return false;
  if ((times & (times - 1)) == 0)
    spdlog::warn("render {}: {}; again in {} ms", task.job_id, setback.what(), delay.count());
  // Of a job that was canceled, or that another works on, nothing waits.
  if (!workshop_.store.release(task, delay.count(), true)) workshop_.setbacks.clear(task.job_id);
  return true;
}

}  // namespace translucube::server
