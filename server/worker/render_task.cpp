#include "server/worker/render_task.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <new>

#include "api/answer/render_status.h"
#include "api/request/sweep.h"
#include "picture/image_io.h"
#include "renderer/base/deadline.h"
#include "renderer/base/parallel.h"
#include "renderer/film/explorable_file.h"
#include "server/pictures/image_artifacts.h"
#include "server/worker/task_watch.h"

namespace translucube::server {
namespace {

using std::chrono::steady_clock;

// A render that ends the process this often (crash, out of memory) is given up.
constexpr int max_attempts = 20;
// A disk that refuses is tried again for about two minutes.
constexpr int max_storage_attempts = 8;
constexpr double seconds_between_checkpoints = 2;

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

double seconds_since(steady_clock::time_point start) {
  return std::chrono::duration<double>(steady_clock::now() - start).count();
}

}  // namespace

int TaskRunner::threads() const { return thread_count(workshop_.threads); }

std::optional<std::uint32_t> TaskRunner::total_samples() const {
  const auto* target = std::get_if<SampleTarget>(&hand_.job.quality());
  return target ? std::optional(target->samples) : std::nullopt;
}

void TaskRunner::run(const Task& task, std::stop_source work) {
  try {
    if (task.attempts > max_attempts) {
      fail(task, {api::ProblemCode::internal,
                  "The service ended too often while it worked on this render.",
                  {}});
      return;
    }
    run_or_throw(task, work);
    return;
  } catch (const StoreError& error) {
    retry_later(task, error.what());
  } catch (const FileError& error) {
    retry_later(task, error.what());
  } catch (const SceneError& error) {
    fail(task, {api::ProblemCode::invalid_request,
                "The scene cannot be built.",
                {{pointer_of(error.part), error.what()}}});
  } catch (const std::bad_alloc&) {
    fail(task,
         {api::ProblemCode::internal, "There is not enough memory for a render of this size.", {}});
  } catch (const std::exception& error) {
    spdlog::error("render {}: {}", task.job_id, error.what());
    fail(task, {api::ProblemCode::internal, "The renderer failed on this request.", {}});
  }
  forget();
}

void TaskRunner::run_or_throw(const Task& task, std::stop_source work) {
  const std::optional<Job> job = workshop_.store.find(task.job_id);
  if (!job || job->state != api::JobState::running) {
    // Canceled or removed between the claim and here.
    if (!workshop_.store.release(task)) tidy(task.job_id);
    return;
  }
  const TaskWatch watch(workshop_.store, task, work);
  if (!take_in_hand(task, *job, work.get_token())) return;

  // A crash may have come between the partial film and its entry in the store.
  std::optional<PassFilm> pass = workshop_.artifacts.read_pass(task.job_id, task.pass);
  double task_seconds = pass ? pass->cpu_seconds / threads() : 0;
  const bool stored = pass.has_value();
  if (!pass) {
    const auto start = steady_clock::now();
    std::optional<Deadline> deadline;
    double time_left = std::numeric_limits<double>::infinity();
    // The first pass always ends: a picture of nothing is of no use.
    if (const auto* target = std::get_if<TimeTarget>(&hand_.job.quality());
        target && task.pass.index > 0) {
      time_left = target->seconds - hand_.seconds;
      deadline.emplace(work, time_left);
    }
    pass = workshop_.engine.trace(*hand_.scene, task.pass, workshop_.threads, work.get_token());
    task_seconds = seconds_since(start);
    if (!pass && task_seconds >= time_left) {
      finish(task, task_seconds, false);
      return;
    }
  }
  if (!pass) {
    if (!workshop_.store.release(task)) tidy(task.job_id);
    return;
  }
  if (!stored) {
    const TraceCounters& counters = pass->counters;
    workshop_.metrics.count_pass(
        {task_seconds, counters.camera_samples,
         counters.flights + counters.boundary_events + counters.light_samples, counters.nan_samples});
  }

  if (!stored && task_seconds > seconds_between_checkpoints)
    workshop_.artifacts.write_pass(task.job_id, *pass);
  workshop_.live_films.merge(*hand_.live, *pass);
  if (hand_.film().counters.nan_samples > 0) {
    fail(task, {api::ProblemCode::internal,
                "The renderer made " + std::to_string(hand_.film().counters.nan_samples) +
                    " samples that are not finite: a bug, please report this request.",
                {}});
    return;
  }
  const double seconds = hand_.seconds + task_seconds;
  const std::optional<Pass> next =
      plan_pass(hand_.film().passes, hand_.job.pixels(), total_samples());
  if (!next || meets(hand_.job.quality(), hand_.film(), seconds)) {
    pass.reset();
    finish(task, task_seconds, true);
    return;
  }

  // An explorable film is written when it is put down, or with a checkpoint: that takes longer than
  // a short pass.
  if (!stored && task_seconds <= seconds_between_checkpoints && !hand_.film().shares)
    workshop_.artifacts.write_pass(task.job_id, *pass);
  pass.reset();
  const Completion completion{task_seconds,
                              progress_of(hand_.film(), hand_.job.quality(), seconds)};
  if (!workshop_.store.complete(task, completion, *next)) {
    forget();
    tidy(task.job_id);
    return;
  }
  hand_.seconds = seconds;
  if (seconds - hand_.seconds_at_checkpoint >=
      std::max(seconds_between_checkpoints, hand_.least_between_checkpoints))
    keep_checkpoint();
}

/// The pictures of all lanes, and what the store keeps of them.
std::vector<StoredResult> TaskRunner::write_pictures(const Task& task, const std::string& stats) {
  // The name belongs to this claim: a late double of it cannot touch a picture that is served.
  const std::string name = "image-" + task.job_id + '-' + std::to_string(task.pass.index) + '-' +
                           std::to_string(task.fencing_token) + ".exr";
  std::vector<StoredResult> results;
  for (std::size_t lane = 0; lane < hand_.job.requests.size(); ++lane) {
    StoredResult result{hand_.job.contents[lane], name, {}, 0, stats};
    const std::string& canonical = hand_.job.canonical[lane];
    const auto write = [&](const std::string& file_name, const auto& writer) {
      workshop_.artifacts.write(result.content, file_name, [&](const std::filesystem::path& file) {
        try {
          writer(file);
        } catch (const ImageError& error) {
          throw FileError(error.what());
        }
      });
      return std::filesystem::file_size(workshop_.artifacts.path(result.content, file_name));
    };
    Image picture;
    if (hand_.film().shares) {
      const auto film =
          std::make_shared<const ExplorableFilm>(explorable_film(*hand_.scene, hand_.film()));
      result.bytes = write(explorable_name(name), [&](const std::filesystem::path& file) {
        write_explorable(file, *film, canonical);
      });
      picture = develop_explorable(*film, *hand_.scene, workshop_.threads);
      workshop_.explorables.keep(explorable_name(name), film);
    } else {
      picture = develop(hand_.film(), static_cast<int>(lane));
    }
    result.image_bytes = write(name, [&](const std::filesystem::path& file) {
      write_image(file, picture, ImageFormat::exr, {canonical, "lin_rec709"});
    });
    result.bytes += *result.image_bytes;
    results.push_back(std::move(result));
  }
  return results;
}

/// Removes pictures of ours that the store did not take.
void TaskRunner::discard(const std::vector<StoredResult>& results) {
  for (const StoredResult& ours : results) {
    const std::optional<StoredResult> kept = workshop_.store.find_result(ours.content);
    if (kept && kept->image == ours.image) continue;
    workshop_.artifacts.remove(ours.content, ours.image);
    workshop_.artifacts.remove(ours.content, explorable_name(ours.image));
  }
}

void TaskRunner::finish(const Task& task, double task_seconds, bool with_pass) {
  const double seconds = hand_.seconds + task_seconds;
  const std::string stats =
      api::stats_json(workshop_.engine.stats(*hand_.scene, hand_.film(), seconds, threads()));
  const std::vector<StoredResult> results = write_pictures(task, stats);
  const Completion completion{with_pass ? std::optional(task_seconds) : std::nullopt,
                              progress_of(hand_.film(), hand_.job.quality(), seconds)};
  const bool finished = workshop_.store.finish(task, completion, stats, results);
  discard(results);
  if (finished) {
    workshop_.metrics.count_render(seconds);
    workshop_.metrics.count_traced_image();
    for (std::size_t lane = 0; lane < results.size(); ++lane)
      workshop_.metrics.count_developed_image();
    workshop_.artifacts.remove_all(task.job_id);
  } else {
    tidy(task.job_id);
  }
  forget();
}

void TaskRunner::fail(const Task& task, const api::Problem& problem) {
  spdlog::error("render {} failed: {}", task.job_id, problem.detail);
  forget();
  try {
    workshop_.store.fail(task, api::to_json(problem));
    tidy(task.job_id);
  } catch (const std::exception& error) {
    // The lease runs out and the task comes again.
    spdlog::error("render {}: {}", task.job_id, error.what());
  }
}

void TaskRunner::retry_later(const Task& task, const std::string& reason) {
  if (task.attempts >= max_storage_attempts) {
    spdlog::error("render {}: {}", task.job_id, reason);
    fail(task, {api::ProblemCode::storage_failure, "The service could not store the render.", {}});
    return;
  }
  const std::int64_t delay_ms = std::min<std::int64_t>(30'000, 500LL << task.attempts);
  spdlog::warn("render {}: {}; again in {} ms", task.job_id, reason, delay_ms);
  try {
    if (!workshop_.store.release(task, delay_ms, true)) tidy(task.job_id);
  } catch (const StoreError& error) {
    spdlog::error("render {}: {}", task.job_id, error.what());
  }
}

/// Removes the files of a job that will never be asked for them.
void TaskRunner::tidy(const std::string& id) {
  const std::optional<Job> job = workshop_.store.find(id);
  if (job && job->state != api::JobState::canceled && job->state != api::JobState::failed) return;
  try {
    workshop_.artifacts.remove_all(id);
  } catch (const FileError& error) {
    spdlog::warn("render {}: {}", id, error.what());  // the next start tries again
  }
}

}  // namespace translucube::server
