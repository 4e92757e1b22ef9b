#pragma once

// The durable queue: job -> tasks -> partial films -> merged film. A task is one pass of the
// renderer, an independent replicate of the sampling, handed out under a lease with a fencing token
// in one short transaction. The work happens outside of the store; a result that comes late or
// twice is refused, which harms nothing, since a pass has the same bits whoever traces it.
//
// Threads: every function may be called by any thread. Writers share one SQLite connection and take
// turns on its mutex; `find` and `list` have a second connection of their own, so that in WAL mode
// a reader never waits for a writer's fsync. Processes: one at a time for each file (DataFolder
// holds the lock); what another owner leased is therefore free again when the store is opened.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "api/job_state.h"
#include "renderer/film.h"
#include "renderer/render.h"
#include "server/clock.h"
#include "server/ids.h"

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

struct Job {
  std::string id;
  api::JobState state = api::JobState::queued;
  std::string request;   ///< canonical, JSON text
  std::string material;  ///< report, JSON text
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> started_ms, finished_ms;
  Progress progress;
  std::optional<std::string> stats, error;  ///< JSON texts
  std::optional<std::string> image;         ///< name of the artifact, where it has succeeded
};

struct NewJob {
  std::string request, material;
  std::optional<std::string> idempotency_key;
  std::optional<std::uint32_t> total_samples;
  Pass first_pass;
};

struct IdempotencyMismatch {};
struct Submitted {
  Job job;
  bool created = false;  ///< false: the key was used for the same request before
};

/// A claim on one pass of a job.
struct Task {
  std::string job_id;
  Pass pass;
  std::int64_t fencing_token = 0;
  int attempts = 0;  ///< claims so far that were not given back, this one included
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

struct StoreOptions {
  std::int64_t lease_ms = 30'000;
  Clock clock = system_clock_ms;
};

class JobStore {
 public:
  /// Opens or creates the store; ":memory:" lives as long as the object. Tasks that another process
  /// held are claimable again, running jobs are queued again. Throws StoreError.
  explicit JobStore(const std::filesystem::path& file, StoreOptions options = {});
  ~JobStore();

  std::variant<Submitted, IdempotencyMismatch> submit(const NewJob& job);
  std::optional<Job> find(const std::string& id) const;
  std::vector<Job> list(const JobFilter& filter) const;  ///< newest first
  /// Ends the job if it has not ended. The job as it is then; empty if there is none.
  std::optional<Job> cancel(const std::string& id);
  bool remove(const std::string& id);  ///< with its tasks; false if there is none

  /// The oldest task that nobody holds, of `preferred` if that has one. Its job is running then.
  std::optional<Task> claim(const std::string& preferred = {});
  /// The functions below do nothing and return false if the claim is no longer the task's last one.
  bool renew(const Task& task);
  bool release(const Task& task, std::int64_t delay_ms = 0, bool counts_as_attempt = false);
  bool complete(const Task& task, const TaskResult& result, const Pass& next);
  /// The job has succeeded, with the task's pass, or without it where its time ran out.
  bool finish(const Task& task, const TaskResult& result, bool with_pass, const std::string& stats,
              const std::string& image);
  bool fail(const Task& task, const std::string& error);

  double traced_seconds(const std::string& id) const;  ///< sum over the finished tasks
  void check_writable();                               ///< throws StoreError
  std::int64_t lease_ms() const { return options_.lease_ms; }

 private:
  std::optional<Job> find_on(sql::Connection& connection, const std::string& id) const;
  bool holds(const Task& task);
  bool move(const std::string& id, api::JobState to);
  std::optional<Task> claim_one(const std::string& only_job);

  StoreOptions options_;
  std::string owner_;  ///< this process
  std::unique_ptr<sql::Connection> writer_, own_reader_;
  sql::Connection* reader_;  ///< the writer for ":memory:"
  std::unique_ptr<IdSource> ids_;
};

}  // namespace translucube::server
