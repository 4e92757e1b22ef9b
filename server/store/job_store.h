#pragma once

// The room of what is durable: the queue of jobs and tasks, what is known of results, and the
// files. It knows nothing of how a picture is made or served.
//
// To add a store: a class that is a JobStore in a folder beside sqlite/, a line in
// open_job_store.cpp that tells its location from the others', and a line in the list of
// tests/server/store/job_store_test.cpp, whose tests say what every store must do.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/base/result.h"
#include "server/base/clock.h"
#include "server/store/job.h"
#include "server/store/store_error.h"

namespace translucube::server {

/// The durable queue: sweep -> jobs -> tasks -> partial films -> film -> results (job.h). Tasks are
/// handed out under a lease with a fencing token in one short transaction. The work happens outside
/// of the store; what comes late or twice is refused, which harms nothing, since a pass has the
/// same bits whoever traces it.
///
/// Every function may be called by any thread and is one transaction. What it was told is durable
/// when it returns, but for a claim. All throw StoreError.
class JobStore {
 public:
  virtual ~JobStore() = default;

  // Renders and sweeps. What is all there already has succeeded at once; a submit is refused as
  // refusals.h says.
  virtual api::Result<Submitted<Job>> submit(const NewJob& job) = 0;
  virtual api::Result<Submitted<StoredSweep>> submit(const NewSweep& sweep) = 0;
  virtual std::optional<Job> find(const std::string& id) const = 0;  ///< images of sweeps too
  virtual std::optional<StoredSweep> find_sweep(const std::string& id) const = 0;
  virtual std::vector<Job> list(const JobFilter& filter) const = 0;  ///< renders, newest first
  virtual std::vector<StoredSweep> list_sweeps(const JobFilter& filter) const = 0;
  virtual std::vector<Picture> pictures(const std::string& job_id) const = 0;  ///< by lane
  virtual std::vector<SweepImageState> sweep_images(const std::string& sweep_id) const = 0;
  virtual std::optional<PointPicture> picture_of_point(const std::string& sweep_id,
                                                       std::uint32_t point) const = 0;
  /// Ends a job, or a sweep with all its jobs, where that has not ended.
  virtual void cancel(const std::string& id) = 0;
  /// Removes a job, or a sweep with all its jobs, and the results that nothing else refers to,
  /// which are told for their files. Empty if there is none of this id.
  virtual std::optional<std::vector<StoredResult>> remove(const std::string& id) = 0;

  /// Some of the renders and sweeps that ended before this time, the oldest first.
  virtual std::vector<std::string> ended_before(std::int64_t time_ms, int most) const = 0;

  // Tasks.
  /// The oldest task of this priority that nobody holds, of the job `preferred` if that has one.
  /// Its job is running then.
  virtual std::optional<Task> claim(Priority priority, const std::string& preferred = {},
                                    Intake intake = Intake::all) = 0;
  // The functions below do nothing and return false if the claim is no longer the task's last one.
  virtual bool renew(const Task& task) = 0;
  virtual bool release(const Task& task, std::int64_t delay_ms = 0,
                       bool counts_as_attempt = false) = 0;
  virtual bool complete(const Task& task, const Completion& completion, const Pass& next) = 0;
  /// The job has succeeded. One result for each lane; of those that are there already (someone was
  /// faster) the first stay.
  virtual bool finish(const Task& task, const Completion& completion, const std::string& stats,
                      const std::vector<StoredResult>& results) = 0;
  /// The job has succeeded: all its results are there. False also if one is not.
  virtual bool finish_from_results(const Task& task) = 0;
  virtual bool fail(const Task& task, const std::string& error) = 0;
  virtual std::int64_t lease_ms() const = 0;

  // The end of the process. A store that is opened again frees the tasks that were held when its
  // last process died. Their jobs are suspects: each is worked on alone, before all others, until a
  // pass of it is complete. One that was alone at two deaths, with no complete pass between, has
  // failed; at four, where the process was killed from outside before the task was renewed once.
  /// This process ends as it was told to: what it holds when it does is not suspect.
  virtual void announce_end() = 0;

  // Results.
  virtual std::optional<StoredResult> find_result(const std::string& content) const = 0;
  virtual void touch_result(const std::string& content) = 0;  ///< it was used now
  virtual void resize_result(const std::string& content, std::uint64_t bytes) = 0;
  /// Its files are to be removed. False if it is not there, or another one of this content is.
  virtual bool remove_result(const StoredResult& result) = 0;
  /// Forgets it: its picture is not there, or not whole. What there is stays.
  virtual void lose_result(const StoredResult& result) = 0;
  /// The results that were not used for longest and make up `bytes` or more, by their last use.
  virtual std::vector<StoredResult> least_recently_used(std::uint64_t bytes) const = 0;
  virtual std::uint64_t result_bytes() const = 0;

  // Files. What was removed above is left over until its files are gone. Only what stands here may
  // be removed: a store that was lost in part, or put back from a copy, knows less than the disk.
  virtual std::vector<Leftover> leftovers() const = 0;
  virtual void forget(const Leftover& removed) = 0;

  // Watching.
  /// Those of a render or a sweep after `number`, in their order; nothing for what is not there.
  virtual std::vector<Event> events_after(const std::string& subject,
                                          std::uint64_t number) const = 0;
  /// The number of the last event of a render or a sweep, 0 where there is none.
  virtual std::uint64_t last_event(const std::string& subject) const = 0;
  virtual QueueGauges gauges() const = 0;
  virtual OpenNeeds open_needs() const = 0;
  virtual void check_writable() = 0;
  /// Brings what was written since the last time to where the loss of a journal does not touch it.
  /// Others go on reading and writing meanwhile.
  virtual void checkpoint() = 0;
};

struct StoreOptions {
  std::int64_t lease_ms = 30'000;
  Clock clock = system_clock_ms;           ///< what people read
  Clock lease_clock = monotonic_clock_ms;  ///< leases and delays: it never jumps
  std::uint64_t most_queued = 20'000;      ///< jobs that have not ended
  double interactive_seconds = 10;         ///< a render that has been traced longer is batch work
  bool last_crashed = false;  ///< the last process ended by a fault of its own (crash_mark.h)
};

/// Opens or creates the store at a location: the file of an SQLite database, or ":memory:" for one
/// that lives as long as the object. Throws StoreError.
std::unique_ptr<JobStore> open_job_store(const std::string& location, StoreOptions options = {});

}  // namespace translucube::server
