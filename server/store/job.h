#pragma once

// What a job store holds, as values. One word, one meaning:
//
// - A job is one traced image: a render, or one of the images of a sweep.
// - A pass (renderer/film) is an independent replicate of the sampling of a job's image. A task is
//   one pass to be traced, claimed by one worker at a time.
// - A partial film (PassFilm) is what the tracing of a task gives; a film is the merged passes.
// - A lane of a film is one absorber. A picture is a lane of a job's film, developed; it is known
// by
//   its content (content.h), and the points of a sweep that differ in absorption alone are lanes of
//   one film.
// - A result is a finished picture that is kept. Whoever asks for the same content gets the same
//   result.
// - An artifact (artifact_store.h) is any file of a job, a result or a sweep.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "api/base/job_state.h"
#include "renderer/film/film.h"
#include "renderer/render.h"

namespace translucube::server {

/// One traced image of a sweep, of which the job is.
struct SweepImage {
  std::string sweep_id;
  std::uint32_t index = 0;
};

struct Job {
  std::string id;
  api::JobState state = api::JobState::queued;
  std::string request;   ///< canonical, JSON text; empty for an image of a sweep
  std::string material;  ///< report, JSON text; empty for an image of a sweep
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> started_ms, finished_ms;
  Progress progress;
  std::optional<std::string> stats, error;  ///< JSON texts
  bool cached = false;                      ///< its results were there before it was worked on
  std::optional<SweepImage> sweep_image;
};

struct Picture {
  std::uint32_t point = 0;  ///< of the sweep; 0 for a render
  std::string content;
};

/// A result, and the files that hold it.
struct StoredResult {
  std::string content;                         ///< the folder of its files
  std::string image;                           ///< the file's name
  std::optional<std::uint64_t> image_bytes{};  ///< unknown for results of an old store
  std::uint64_t bytes = 0;                     ///< of all its files
  std::string stats;                           ///< of the render that made it, JSON text
};

/// Files of what the store has no longer.
struct Leftover {
  std::string folder;  ///< of a job, of a sweep, or of a result
  std::string image;   ///< of a result; "": all that is in the folder
  friend bool operator==(const Leftover&, const Leftover&) = default;
};

struct StoredSweep {
  std::string id;
  api::JobState state = api::JobState::queued;
  std::string request;  ///< canonical, JSON text
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> started_ms, finished_ms;
  std::uint32_t points = 0, images = 0;
};

/// How far one traced image of a sweep is.
struct SweepImageState {
  std::string job_id;
  api::JobState state = api::JobState::queued;
  std::optional<std::string> stats, error;  ///< JSON texts
  bool cached = false;
  std::vector<std::uint32_t> points;  ///< by lane
};

/// How far the picture of one point of a sweep is.
struct PointPicture {
  api::JobState state = api::JobState::queued;
  std::string content;
};

struct NewJob {
  std::string request, material;
  std::optional<std::string> idempotency_key;
  std::optional<std::uint32_t> total_samples;
  Pass first_pass;
  std::string content;
  std::uint64_t picture_bytes = 0;  ///< that its picture will take on the disk, at most
};

struct NewSweep {
  std::string request;
  std::optional<std::string> idempotency_key;
  std::optional<std::uint32_t> total_samples;  ///< of each image
  Pass first_pass;
  std::vector<std::vector<Picture>> images;  ///< the lanes of each
  std::uint64_t picture_bytes = 0;           ///< of each lane
};

/// `Stored`: Job or StoredSweep.
template <typename Stored>
struct Submitted {
  Stored stored;
  bool created = false;  ///< false: the key was used for the same request before
};

/// What the jobs that have not ended will take on the disk for their pictures.
struct OpenNeeds {
  std::uint64_t bytes = 0;
  std::uint64_t largest = 0;  ///< of one job
};

/// Who is served first: renders that somebody waits for, or what takes long.
enum class Priority { interactive = 0, batch = 1 };

/// A claim on one pass of a job. The fencing token tells the claims of a task apart: the result of
/// an earlier one is refused.
struct Task {
  std::string job_id;
  Pass pass;
  std::int64_t fencing_token = 0;
  int attempts = 0;  ///< claims so far that were not given back, this one included
  Priority priority = Priority::interactive;
};

/// What a worker tells of a task that has ended well.
struct Completion {
  /// Wall clock of the tracing; empty where the pass was given up because the render's time is
  /// over.
  std::optional<double> pass_seconds;
  Progress progress;  ///< after the merge
};

struct JobFilter {
  std::optional<api::JobState> state;
  std::optional<std::string> before_id;  ///< only older ones
  int limit = 50;
};

/// What watchers of a render or a sweep are told; numbered from 1 without a gap.
struct Event {
  std::uint64_t number = 0;
  std::string type, data;  ///< JSON text
};

/// Which tasks may be handed out: all, those of jobs that were begun before, or none.
enum class Intake { all, begun, none };

/// A look at the queue, for /metrics. Indexed by JobState and by Priority.
struct QueueGauges {
  std::array<std::uint64_t, api::all_job_states.size()> jobs{}, sweeps{};
  std::array<std::uint64_t, 2> waiting_tasks{};
  double oldest_waiting_s = 0;
  std::uint64_t results = 0, result_bytes = 0;
};

}  // namespace translucube::server
