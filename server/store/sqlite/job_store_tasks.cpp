#include "api/answer/event.h"
#include "server/store/sqlite/job_store_rows.h"

namespace translucube::server {

using api::JobState;
using rows::Lock;
using sql::Statement;
using sql::Transaction;

namespace {

void store_progress(sql::Connection& connection, const std::string& id, const Progress& progress) {
  Statement(connection,
            "UPDATE jobs SET passes = ?, samples = ?, total_samples = ?, relative_error = ?, "
            "seconds = ?, eta_seconds = ? WHERE id = ?")
      .bind(progress.passes, progress.samples, progress.total_samples, progress.relative_error,
            progress.seconds, progress.eta_seconds, id)
      .run();
}

void end_task(sql::Connection& connection, const Task& task, double seconds) {
  Statement(connection,
            "UPDATE tasks SET state = 'done', seconds = ? WHERE job_id = ? AND pass_index = ?")
      .bind(seconds, task.job_id, task.pass.index)
      .run();
}

}  // namespace

std::optional<Task> JobStore::claim_one(Priority priority, const std::string& only_job) {
  const std::int64_t now = options_.lease_clock();
  Statement statement(*writer_, std::string(R"sql(
UPDATE tasks SET state = 'leased', owner = ?, lease_until_ms = ?,
                 fencing_token = fencing_token + 1, attempts = attempts + 1
WHERE (job_id, pass_index) = (
  SELECT job_id, pass_index FROM tasks
  WHERE state <> 'done' AND priority = ? AND ((state = 'ready' AND not_before_ms <= ?)
                             OR (state = 'leased' AND lease_until_ms < ?)) )sql") +
                                    (only_job.empty() ? "" : "AND job_id = ? ") +
                                    R"sql(
  ORDER BY job_id, pass_index LIMIT 1)
RETURNING job_id, pass_index, first_sample, sample_count, fencing_token, attempts)sql");
  statement.bind(owner_, now + options_.lease_ms, static_cast<int>(priority), now, now);
  if (!only_job.empty()) statement.bind(only_job);
  if (!statement.step()) return std::nullopt;
  Task task{statement.text(0),
            {static_cast<std::uint32_t>(statement.integer(1)),
             static_cast<std::uint32_t>(statement.integer(2)),
             static_cast<std::uint32_t>(statement.integer(3))},
            statement.integer(4),
            static_cast<int>(statement.integer(5)),
            priority};
  statement.run();
  return task;
}

std::optional<Task> JobStore::claim(Priority priority, const std::string& preferred) {
  const Lock lock(writer_->mutex);
  // A claim that is lost to a power cut is made again: nobody was promised anything.
  const sql::UnsyncedCommits unsynced(*writer_);
  Transaction transaction(*writer_);
  std::optional<Task> task;
  if (!preferred.empty()) task = claim_one(priority, preferred);
  if (!task) task = claim_one(priority, {});
  if (!task) return std::nullopt;
  move(task->job_id, JobState::running);  // no move where it is running already
  transaction.commit();
  return task;
}

bool JobStore::holds(const Task& task) {
  Statement statement(*writer_,
                      "SELECT 1 FROM tasks WHERE job_id = ? AND pass_index = ? AND "
                      "state = 'leased' AND fencing_token = ?");
  return statement.bind(task.job_id, task.pass.index, task.fencing_token).step();
}

bool JobStore::renew(const Task& task) {
  const Lock lock(writer_->mutex);
  if (!holds(task)) return false;
  Statement(*writer_, "UPDATE tasks SET lease_until_ms = ? WHERE job_id = ? AND pass_index = ?")
      .bind(options_.lease_clock() + options_.lease_ms, task.job_id, task.pass.index)
      .run();
  return true;
}

bool JobStore::release(const Task& task, std::int64_t delay_ms, bool counts_as_attempt) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (!holds(task)) return false;
  Statement(*writer_,
            "UPDATE tasks SET state = 'ready', owner = NULL, not_before_ms = ?, "
            "attempts = attempts - ? WHERE job_id = ? AND pass_index = ?")
      .bind(options_.lease_clock() + delay_ms, counts_as_attempt ? 0 : 1, task.job_id,
            task.pass.index)
      .run();
  move(task.job_id, JobState::queued);
  transaction.commit();
  return true;
}

bool JobStore::complete(const Task& task, const TaskResult& result, const Pass& next) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (!holds(task)) return false;
  end_task(*writer_, task, result.seconds);
  store_progress(*writer_, task.job_id, result.progress);
  const bool long_one = result.progress.seconds >= options_.interactive_seconds;
  rows::insert_task(*writer_, task.job_id, next, long_one ? Priority::batch : task.priority);
  Statement render(*writer_, "SELECT 1 FROM jobs WHERE id = ? AND sweep_id IS NULL");
  if (render.bind(task.job_id).step())
    tell(task.job_id, "progress", api::progress_event(result.progress));
  transaction.commit();
  return true;
}

bool JobStore::finish(const Task& task, const TaskResult& result, bool with_pass,
                      const std::string& stats, const std::vector<StoredResult>& results) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (!holds(task)) return false;
  if (with_pass) end_task(*writer_, task, result.seconds);
  rows::delete_open_tasks(*writer_, task.job_id);
  store_progress(*writer_, task.job_id, result.progress);
  for (const StoredResult& made : results)
    Statement(*writer_,
              "INSERT OR IGNORE INTO results(content, image, image_bytes, stats, bytes, used_ms) "
              "VALUES (?, ?, ?, ?, ?, ?)")
        .bind(made.content, made.image,
              made.image_bytes ? std::optional(static_cast<std::int64_t>(*made.image_bytes))
                               : std::nullopt,
              made.stats, static_cast<std::int64_t>(made.bytes), options_.clock())
        .run();
  Statement(*writer_, "UPDATE jobs SET stats = ? WHERE id = ?").bind(stats, task.job_id).run();
  if (!move(task.job_id, JobState::succeeded)) return false;
  transaction.commit();
  return true;
}

bool JobStore::finish_from_results(const Task& task) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (!holds(task)) return false;
  Statement missing(*writer_,
                    "SELECT 1 FROM pictures WHERE job_id = ? AND NOT EXISTS "
                    "(SELECT 1 FROM results WHERE results.content = pictures.content)");
  if (missing.bind(task.job_id).step()) return false;
  Statement made(*writer_,
                 "SELECT stats FROM results JOIN pictures USING (content) "
                 "WHERE job_id = ? AND lane = 0");
  if (!made.bind(task.job_id).step()) return false;
  rows::delete_open_tasks(*writer_, task.job_id);
  Statement(*writer_, "UPDATE jobs SET stats = ?, cached = 1 WHERE id = ?")
      .bind(made.text(0), task.job_id)
      .run();
  if (!move(task.job_id, JobState::succeeded)) return false;
  transaction.commit();
  return true;
}

bool JobStore::fail(const Task& task, const std::string& error) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (!holds(task)) return false;
  rows::delete_open_tasks(*writer_, task.job_id);
  Statement(*writer_, "UPDATE jobs SET error = ? WHERE id = ?").bind(error, task.job_id).run();
  if (!move(task.job_id, JobState::failed)) return false;
  transaction.commit();
  return true;
}

double JobStore::traced_seconds(const std::string& id) const {
  const Lock lock(writer_->mutex);
  Statement statement(*writer_, "SELECT SUM(seconds) FROM tasks WHERE job_id = ?");
  return statement.bind(id).step() ? statement.real(0) : 0;
}

}  // namespace translucube::server
