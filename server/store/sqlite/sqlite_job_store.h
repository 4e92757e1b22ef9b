#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/base/ids.h"
#include "server/store/job_store.h"
#include "server/store/sqlite/connection.h"

namespace translucube::server {

/// The store that needs nothing but a file, and serves one process: DataFolder holds the lock, and
/// what another process held is free again when the file is opened.
///
/// Writers share one connection and take turns on its mutex; what only reads has a second
/// connection of its own, so that in WAL mode a reader never waits for a writer's fsync.
class SqliteJobStore final : public JobStore {
 public:
  /// Opens or creates the file; ":memory:" lives as long as the object. Throws StoreError.
  SqliteJobStore(const std::string& file, StoreOptions options);

  // submit.cpp
  api::Result<Submitted<Job>> submit(const NewJob& job) override;
  api::Result<Submitted<StoredSweep>> submit(const NewSweep& sweep) override;

  // sqlite_job_store.cpp
  std::optional<Job> find(const std::string& id) const override;
  std::optional<StoredSweep> find_sweep(const std::string& id) const override;
  std::vector<Job> list(const JobFilter& filter) const override;
  std::vector<StoredSweep> list_sweeps(const JobFilter& filter) const override;
  std::vector<Picture> pictures(const std::string& job_id) const override;
  std::vector<SweepImageState> sweep_images(const std::string& sweep_id) const override;
  std::optional<PointPicture> picture_of_point(const std::string& sweep_id,
                                               std::uint32_t point) const override;
  std::optional<std::vector<StoredResult>> remove(const std::string& id) override;
  std::vector<std::string> ended_before(std::int64_t time_ms, int most) const override;
  void check_writable() override;
  void checkpoint() override;

  // tasks.cpp
  std::optional<Task> claim(Priority priority, const std::string& preferred,
                            Intake intake) override;
  bool renew(const Task& task) override;
  bool release(const Task& task, std::int64_t delay_ms, bool counts_as_attempt) override;
  bool complete(const Task& task, const Completion& completion, const Pass& next) override;
  bool finish(const Task& task, const Completion& completion, const std::string& stats,
              const std::vector<StoredResult>& results) override;
  bool finish_from_results(const Task& task) override;
  bool fail(const Task& task, const std::string& error) override;
  std::int64_t lease_ms() const override { return options_.lease_ms; }

  // recovery.cpp
  void announce_end() override;

  // results.cpp
  std::optional<StoredResult> find_result(const std::string& content) const override;
  void touch_result(const std::string& content) override;
  void resize_result(const std::string& content, std::uint64_t bytes) override;
  bool remove_result(const StoredResult& result) override;
  void lose_result(const StoredResult& result) override;
  std::vector<Leftover> leftovers() const override;
  void forget(const Leftover& removed) override;
  std::vector<StoredResult> least_recently_used(std::uint64_t bytes) const override;
  std::uint64_t result_bytes() const override;

  // states.cpp
  void cancel(const std::string& id) override;
  std::vector<Event> events_after(const std::string& subject, std::uint64_t number) const override;
  std::uint64_t last_event(const std::string& subject) const override;
  QueueGauges gauges() const override;
  OpenNeeds open_needs() const override;

 private:
  struct NewRow;

  // All inside of a transaction of the writer.
  bool queue_has_room(std::size_t jobs);
  std::string insert_job(const NewRow& row);
  std::optional<std::string> use_results(const std::vector<Picture>& lanes, std::int64_t now);
  void leave_over(const Leftover& removed);
  void insert_results(const std::vector<StoredResult>& results);
  std::vector<StoredResult> drop_unused_results(const std::vector<std::string>& contents);
  void take_over();
  void judge(const std::string& id, bool for_sure);
  enum class Trial { none, due, under_way };
  Trial trial();
  template <typename... Values>
  std::optional<Task> claim_one(const std::string& condition, const Values&... values);
  bool holds(const Task& task);
  bool move(const std::string& id, api::JobState to);
  void follow_sweep(const std::string& sweep_id);
  void cancel_sweep(const std::string& id);
  void tell(const std::string& subject, const std::string& type, const std::string& data);
  void tell_state(const std::string& id);

  /// Runs `work` in a transaction while the claim is the task's last one, and commits if it says
  /// so.
  template <typename Work>
  bool while_held(const Task& task, Work&& work) {
    sql::Transaction transaction(writer_);
    if (!holds(task) || !work()) return false;
    transaction.commit();
    return true;
  }

  StoreOptions options_;
  std::string owner_;  ///< this process
  sql::Connection writer_;
  std::unique_ptr<sql::Connection> own_reader_;
  sql::Connection& reader_;                        ///< the writer for ":memory:"
  std::unique_ptr<sql::Connection> checkpointer_;  ///< nullptr for ":memory:"
  std::unique_ptr<IdSource> ids_;
};

}  // namespace translucube::server
