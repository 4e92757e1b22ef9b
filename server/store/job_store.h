#pragma once

// The durable queue: sweep -> jobs -> tasks -> partial films -> merged film -> results. A job is
// one traced image: a render, or one of the images of a sweep. A task is one pass of the renderer,
// an independent replicate of the sampling, handed out under a lease with a fencing token in one
// short transaction. The work happens outside of the store; a result that comes late or twice is
// refused, which harms nothing, since a pass has the same bits whoever traces it. A result is a
// finished picture, known by its content (content.h): whoever asks for the same picture gets the
// same result.
//
// Threads: every function may be called by any thread. Writers share one SQLite connection and take
// turns on its mutex; what only reads has a second connection of its own, so that in WAL mode a
// reader never waits for a writer's fsync. Processes: one at a time for each file (DataFolder holds
// the lock); what another owner leased is therefore free again when the store is opened.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/base/job_state.h"
#include "api/base/result.h"
#include "renderer/film/film.h"
#include "renderer/render.h"
#include "server/base/clock.h"
#include "server/base/ids.h"

namespace translucube::server {

struct StoreError : std::runtime_error {
  enum class Kind { unavailable, full, corrupt };
  Kind kind;
  StoreError(Kind k, const std::string& what) : std::runtime_error(what), kind(k) {}
};

namespace sql {
class Connection;
class Statement;
}  // namespace sql

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

/// A picture that a job makes: a lane of its film.
struct Picture {
  std::uint32_t point = 0;  ///< of the sweep; 0 for a render
  std::string content;
};

/// A finished picture on the disk, and what belongs to it.
struct StoredResult {
  std::string content;                         ///< the folder of its files
  std::string image;                           ///< the file's name
  std::optional<std::uint64_t> image_bytes{};  ///< unknown for results of an old store
  std::uint64_t bytes = 0;                     ///< of all its files
  std::string stats;                           ///< of the render that made it, JSON text
};

struct NewJob {
  std::string request, material;
  std::optional<std::string> idempotency_key;
  std::optional<std::uint32_t> total_samples;
  Pass first_pass;
  std::string content;
};

struct Submitted {
  Job job;
  bool created = false;  ///< false: the key was used for the same request before
};

struct StoredSweep {
  std::string id;
  api::JobState state = api::JobState::queued;
  std::string request;  ///< canonical, JSON text
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> started_ms, finished_ms;
  std::uint32_t points = 0, images = 0;
};
struct NewSweep {
  std::string request;
  std::optional<std::string> idempotency_key;
  std::optional<std::uint32_t> total_samples;  ///< of each image
  Pass first_pass;
  std::vector<std::vector<Picture>> images;  ///< the lanes of each
};
struct SubmittedSweep {
  StoredSweep sweep;
  bool created = false;
};
/// How far one traced image of a sweep is.
struct SweepImageState {
  std::string job_id;
  api::JobState state = api::JobState::queued;
  std::optional<std::string> stats, error;  ///< JSON texts
  bool cached = false;
  std::vector<std::uint32_t> points;  ///< by lane
};

/// What watchers of a job or a sweep are told; numbered from 1 without a gap.
struct Event {
  std::uint64_t number = 0;
  std::string type, data;  ///< JSON text
};

/// Who is served first: renders that somebody waits for, or what takes long.
enum class Priority { interactive = 0, batch = 1 };

/// A claim on one pass of a job.
struct Task {
  std::string job_id;
  Pass pass;
  std::int64_t fencing_token = 0;
  int attempts = 0;  ///< claims so far that were not given back, this one included
  Priority priority = Priority::interactive;
};

struct TaskResult {
  double seconds = 0;  ///< wall clock of the tracing
  Progress progress;   ///< after the merge
};

struct JobFilter {
  std::optional<api::JobState> state;
  std::optional<std::string> before_id;  ///< only older ones
  int limit = 50;
};

/// A look at the queue, for /metrics. Indexed by JobState and by Priority.
struct QueueGauges {
  std::array<std::uint64_t, api::all_job_states.size()> jobs{}, sweeps{};
  std::array<std::uint64_t, 2> waiting_tasks{};
  double oldest_waiting_s = 0;
  std::uint64_t results = 0, result_bytes = 0;
};

struct StoreOptions {
  std::int64_t lease_ms = 30'000;
  Clock clock = system_clock_ms;           ///< what people read
  Clock lease_clock = monotonic_clock_ms;  ///< leases and delays: it never jumps
  std::uint64_t most_queued = 20'000;      ///< jobs that have not ended
  double interactive_seconds = 10;         ///< a render that has been traced longer is batch work
};

class JobStore {
 public:
  /// Opens or creates the store; ":memory:" lives as long as the object. Tasks that another process
  /// held are claimable again, running jobs are queued again. Throws StoreError.
  explicit JobStore(const std::filesystem::path& file, StoreOptions options = {});
  ~JobStore();

  // Renders (job_store.cpp). A job whose result is there already has succeeded at once. A submit is
  // refused as refusals.h says.
  api::Result<Submitted> submit(const NewJob& job);
  std::optional<Job> find(const std::string& id) const;  ///< renders, and images of sweeps
  std::vector<Job> list(const JobFilter& filter) const;  ///< renders, newest first
  /// Ends the job if it has not ended. The job as it is then; empty if there is none.
  std::optional<Job> cancel(const std::string& id);
  /// With its tasks, and the results that nothing else refers to, which are told for their files.
  /// Empty if there is no such job.
  std::optional<std::vector<StoredResult>> remove(const std::string& id);
  std::vector<Picture> pictures(const std::string& job_id) const;  ///< by lane

  // Sweeps (job_store_sweeps.cpp).
  api::Result<SubmittedSweep> submit(const NewSweep& sweep);
  std::optional<StoredSweep> find_sweep(const std::string& id) const;
  std::vector<StoredSweep> list_sweeps(const JobFilter& filter) const;     ///< newest first
  std::vector<SweepImageState> sweep_images(const std::string& id) const;  ///< by index
  struct PointPicture {
    api::JobState state = api::JobState::queued;
    std::string content;
  };
  std::optional<PointPicture> picture_of_point(const std::string& id, std::uint32_t point) const;
  std::optional<StoredSweep> cancel_sweep(const std::string& id);
  std::optional<std::vector<StoredResult>> remove_sweep(const std::string& id);

  // Tasks (job_store_tasks.cpp).
  /// The oldest task of this priority that nobody holds, of `preferred` if that has one. Its job is
  /// running then.
  std::optional<Task> claim(Priority priority, const std::string& preferred = {});
  /// The functions below do nothing and return false if the claim is no longer the task's last one.
  bool renew(const Task& task);
  bool release(const Task& task, std::int64_t delay_ms = 0, bool counts_as_attempt = false);
  bool complete(const Task& task, const TaskResult& result, const Pass& next);
  /// The job has succeeded, with the task's pass, or without it where its time ran out. One result
  /// for each lane; of those that are there already (someone was faster) the first stay.
  bool finish(const Task& task, const TaskResult& result, bool with_pass, const std::string& stats,
              const std::vector<StoredResult>& results);
  /// The job has succeeded: all its results are there. False also if one is not.
  bool finish_from_results(const Task& task);
  bool fail(const Task& task, const std::string& error);
  double traced_seconds(const std::string& id) const;  ///< sum over the finished tasks

  // Results (job_store_results.cpp).
  std::optional<StoredResult> find_result(const std::string& content) const;
  void touch_result(const std::string& content);  ///< it was used now
  void resize_result(const std::string& content, std::uint64_t bytes);
  bool remove_result(const StoredResult& result);  ///< false if it is not there, or another one is
  /// The results that were not used for longest and make up `bytes` or more, by their last use.
  std::vector<StoredResult> least_recently_used(std::uint64_t bytes) const;
  std::uint64_t result_bytes() const;

  // Events (job_store_events.cpp).
  /// Those after `number`, in their order; nothing for what is not there.
  std::vector<Event> events_after(const std::string& subject, std::uint64_t number) const;
  QueueGauges gauges() const;

  void check_writable();  ///< throws StoreError
  std::int64_t lease_ms() const { return options_.lease_ms; }

 private:
  std::optional<Job> find_on(sql::Connection& connection, const std::string& id) const;
  std::optional<StoredSweep> find_sweep_on(sql::Connection& connection,
                                           const std::string& id) const;
  bool queue_has_room(std::size_t jobs);
  std::optional<std::string> use_results(const std::vector<Picture>& lanes, std::int64_t now);
  void insert_pictures(const std::string& id, const std::vector<Picture>& lanes);
  std::vector<StoredResult> drop_unused_results(const std::vector<std::string>& contents);
  bool holds(const Task& task);
  bool move(const std::string& id, api::JobState to);
  void follow_sweep(const std::string& sweep_id);
  void tell(const std::string& subject, const std::string& type, const std::string& data);
  void tell_state(const std::string& id);
  std::optional<Task> claim_one(Priority priority, const std::string& only_job);

  StoreOptions options_;
  std::string owner_;  ///< this process
  std::unique_ptr<sql::Connection> writer_, own_reader_;
  sql::Connection* reader_;  ///< the writer for ":memory:"
  std::unique_ptr<IdSource> ids_;
};

}  // namespace translucube::server
