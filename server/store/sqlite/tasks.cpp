#include "api/answer/event.h"
#include "server/store/sqlite/rows.h"
#include "server/store/sqlite/sqlite_job_store.h"

namespace translucube::server {

using api::JobState;
using rows::Lock;
using sql::Statement;
using sql::Transaction;

namespace {

/// The pass is done where it was whole, and the job has come so far: it was no cause of a death.
void store_completion(sql::Connection& writer, const Task& task, const Completion& completion) {
  if (completion.pass_seconds)
    Statement(writer,
              "UPDATE tasks SET state = 'done', seconds = ? WHERE job_id = ? AND pass_index = ?")
        .bind(*completion.pass_seconds, task.job_id, task.pass.index)
        .run();
  const Progress& progress = completion.progress;
  Statement(writer,
            "UPDATE jobs SET passes = ?, samples = ?, total_samples = ?, relative_error = ?, "
            "seconds = ?, eta_seconds = ?, deaths = 0, suspect = 0 WHERE id = ?")
      .bind(progress.passes, progress.samples, progress.total_samples, progress.relative_error,
            progress.seconds, progress.eta_seconds, task.job_id)
      .run();
}

}  // namespace

/// The oldest task that is due and for which the condition holds.
template <typename... Values>
std::optional<Task> SqliteJobStore::claim_one(const std::string& condition,
                                              const Values&... values) {
  const std::int64_t now = options_.lease_clock();
  Statement statement(writer_, R"sql(
UPDATE tasks SET state = 'leased', owner = ?, lease_until_ms = ?,
                 fencing_token = fencing_token + 1, attempts = attempts + 1, renewed = 0
WHERE (job_id, pass_index) = (
  SELECT job_id, pass_index FROM tasks
  WHERE state <> 'done' AND ((state = 'ready' AND not_before_ms <= ?)
                             OR (state = 'leased' AND lease_until_ms < ?)) AND )sql" +
                                   condition + R"sql(
  ORDER BY job_id, pass_index LIMIT 1)
RETURNING job_id, pass_index, first_sample, sample_count, fencing_token, attempts, priority)sql");
  statement.bind(owner_, now + options_.lease_ms, now, now, values...);
  if (!statement.step()) return std::nullopt;
  Task task{statement.text(0),
            {static_cast<std::uint32_t>(statement.integer(1)),
             static_cast<std::uint32_t>(statement.integer(2)),
             static_cast<std::uint32_t>(statement.integer(3))},
            statement.integer(4),
            static_cast<int>(statement.integer(5)),
            static_cast<Priority>(statement.integer(6))};
  statement.run();
  return task;
}

std::optional<Task> SqliteJobStore::claim(Priority priority, const std::string& preferred,
                                          Intake intake) {
  if (intake == Intake::none) return std::nullopt;
  // A claim that is lost to a power cut is made again: nobody was promised anything.
  Transaction transaction(writer_, sql::Durability::process);
  const int wanted = static_cast<int>(priority);
  const std::string begun = intake == Intake::begun ? " AND pass_index > 0" : "";
  std::optional<Task> task;
  switch (trial()) {
    case Trial::under_way:
      return std::nullopt;
    case Trial::due:
      task = claim_one("job_id IN (SELECT id FROM jobs WHERE suspect = 1)");
      break;
    case Trial::none:
      if (!preferred.empty())
        task = claim_one("priority = ? AND job_id = ?" + begun, wanted, preferred);
      if (!task) task = claim_one("priority = ?" + begun, wanted);
  }
  if (!task) return std::nullopt;
  move(task->job_id, JobState::running);  // no move where it is running already
  transaction.commit();
  return task;
}

bool SqliteJobStore::holds(const Task& task) {
  Statement statement(writer_,
                      "SELECT 1 FROM tasks WHERE job_id = ? AND pass_index = ? AND "
                      "state = 'leased' AND fencing_token = ?");
  return statement.bind(task.job_id, task.pass.index, task.fencing_token).step();
}

bool SqliteJobStore::renew(const Task& task) {
  return while_held(task, [&] {
    Statement(
        writer_,
        "UPDATE tasks SET lease_until_ms = ?, renewed = 1 WHERE job_id = ? AND pass_index = ?")
        .bind(options_.lease_clock() + options_.lease_ms, task.job_id, task.pass.index)
        .run();
    return true;
  });
}

bool SqliteJobStore::release(const Task& task, std::int64_t delay_ms, bool counts_as_attempt) {
  return while_held(task, [&] {
    Statement(writer_,
              "UPDATE tasks SET state = 'ready', owner = NULL, not_before_ms = ?, "
              "attempts = attempts - ? WHERE job_id = ? AND pass_index = ?")
        .bind(options_.lease_clock() + delay_ms, counts_as_attempt ? 0 : 1, task.job_id,
              task.pass.index)
        .run();
    move(task.job_id, JobState::queued);
    return true;
  });
}

bool SqliteJobStore::complete(const Task& task, const Completion& completion, const Pass& next) {
  return while_held(task, [&] {
    store_completion(writer_, task, completion);
    const bool long_one = completion.progress.seconds >= options_.interactive_seconds;
    rows::insert_task(writer_, task.job_id, next, long_one ? Priority::batch : task.priority);
    Statement render(writer_, "SELECT 1 FROM jobs WHERE id = ? AND sweep_id IS NULL");
    if (render.bind(task.job_id).step())
      tell(task.job_id, "progress", api::progress_event(completion.progress));
    return true;
  });
}

bool SqliteJobStore::finish(const Task& task, const Completion& completion,
                            const std::string& stats, const std::vector<StoredResult>& results) {
  return while_held(task, [&] {
    store_completion(writer_, task, completion);
    rows::delete_open_tasks(writer_, task.job_id);
    insert_results(results);
    Statement(writer_, "UPDATE jobs SET stats = ? WHERE id = ?").bind(stats, task.job_id).run();
    return move(task.job_id, JobState::succeeded);
  });
}

bool SqliteJobStore::finish_from_results(const Task& task) {
  return while_held(task, [&] {
    const auto stats = use_results(rows::pictures(writer_, task.job_id), options_.clock());
    if (!stats) return false;
    rows::delete_open_tasks(writer_, task.job_id);
    Statement(writer_, "UPDATE jobs SET stats = ?, cached = 1 WHERE id = ?")
        .bind(*stats, task.job_id)
        .run();
    return move(task.job_id, JobState::succeeded);
  });
}

bool SqliteJobStore::fail(const Task& task, const std::string& error) {
  return while_held(task, [&] {
    rows::delete_open_tasks(writer_, task.job_id);
    Statement(writer_, "UPDATE jobs SET error = ? WHERE id = ?").bind(error, task.job_id).run();
    return move(task.job_id, JobState::failed);
  });
}

}  // namespace translucube::server
