#include "server/job_store.h"

#include <cassert>
#include <limits>

#include "server/job_store_schema.h"
#include "server/job_store_sqlite.h"

namespace translucube::server {
namespace {

using api::JobState;
using sql::Connection;
using sql::Statement;
using sql::Transaction;
using Lock = std::lock_guard<std::mutex>;

constexpr const char* select_job =
    "SELECT id, state, request, material, created_ms, started_ms, finished_ms, passes, samples, "
    "total_samples, relative_error, seconds, eta_seconds, stats, error, image FROM jobs ";

std::string text(JobState state) { return std::string(api::name(state)); }

Job job_of(const Statement& row) {
  const std::optional<JobState> state = api::job_state(row.text(1));
  if (!state) throw StoreError(StoreError::Kind::corrupt, "the job store: an unknown job state");
  Job job{.id = row.text(0),
          .state = *state,
          .request = row.text(2),
          .material = row.text(3),
          .created_ms = row.integer(4),
          .started_ms = row.optional_integer(5),
          .finished_ms = row.optional_integer(6),
          .progress = {},
          .stats = row.optional_text(13),
          .error = row.optional_text(14),
          .image = row.optional_text(15)};
  job.progress.passes = static_cast<std::uint32_t>(row.integer(7));
  job.progress.samples = static_cast<std::uint32_t>(row.integer(8));
  if (!row.is_null(9)) job.progress.total_samples = static_cast<std::uint32_t>(row.integer(9));
  job.progress.relative_error =
      row.optional_real(10).value_or(std::numeric_limits<double>::quiet_NaN());
  job.progress.seconds = row.real(11);
  job.progress.eta_seconds = row.optional_real(12);
  return job;
}

void insert_task(Connection& connection, const std::string& id, const Pass& pass) {
  Statement(connection,
            "INSERT INTO tasks(job_id, pass_index, first_sample, sample_count, state) "
            "VALUES (?, ?, ?, ?, 'ready')")
      .bind(id, pass.index, pass.first_sample, pass.count)
      .run();
}

void delete_open_tasks(Connection& connection, const std::string& id) {
  Statement(connection, "DELETE FROM tasks WHERE job_id = ? AND state <> 'done'").bind(id).run();
}

void store_progress(Connection& connection, const std::string& id, const Progress& progress) {
  Statement(connection,
            "UPDATE jobs SET passes = ?, samples = ?, total_samples = ?, relative_error = ?, "
            "seconds = ?, eta_seconds = ? WHERE id = ?")
      .bind(progress.passes, progress.samples, progress.total_samples, progress.relative_error,
            progress.seconds, progress.eta_seconds, id)
      .run();
}

}  // namespace

JobStore::JobStore(const std::filesystem::path& file, StoreOptions options)
    : options_(std::move(options)), owner_(random_hex(16)) {
  writer_ = std::make_unique<Connection>(file, Connection::Access::read_write);
  prepare_schema(*writer_, file);

  Transaction transaction(*writer_);
  Statement(*writer_, "UPDATE tasks SET state = 'ready', owner = NULL WHERE state = 'leased'")
      .run();
  assert(api::may_follow(JobState::running, JobState::queued));
  Statement(*writer_, "UPDATE jobs SET state = ? WHERE state = ?")
      .bind(text(JobState::queued), text(JobState::running))
      .run();
  Statement newest(*writer_, "SELECT MAX(id) FROM jobs");
  ids_ = std::make_unique<IdSource>(newest.step() ? newest.text(0) : std::string());
  transaction.commit();

  if (file != ":memory:")
    own_reader_ = std::make_unique<Connection>(file, Connection::Access::read_only);
  reader_ = own_reader_ ? own_reader_.get() : writer_.get();
}

JobStore::~JobStore() = default;

std::variant<Submitted, IdempotencyMismatch> JobStore::submit(const NewJob& job) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (job.idempotency_key) {
    Statement same(*writer_, std::string(select_job) + "WHERE idempotency_key = ?");
    if (same.bind(*job.idempotency_key).step()) {
      Job known = job_of(same);
      if (known.request != job.request) return IdempotencyMismatch{};
      return Submitted{std::move(known), false};
    }
  }
  const std::int64_t now = options_.clock();
  const std::string id = ids_->next(now);
  Statement(*writer_,
            "INSERT INTO jobs(id, state, request, material, idempotency_key, created_ms, "
            "total_samples) VALUES (?, ?, ?, ?, ?, ?, ?)")
      .bind(id, text(JobState::queued), job.request, job.material, job.idempotency_key, now,
            job.total_samples)
      .run();
  insert_task(*writer_, id, job.first_pass);
  Submitted submitted{*find_on(*writer_, id), true};
  transaction.commit();
  return submitted;
}

std::optional<Job> JobStore::find_on(Connection& connection, const std::string& id) const {
  Statement statement(connection, std::string(select_job) + "WHERE id = ?");
  if (!statement.bind(id).step()) return std::nullopt;
  return job_of(statement);
}

std::optional<Job> JobStore::find(const std::string& id) const {
  const Lock lock(reader_->mutex);
  return find_on(*reader_, id);
}

std::vector<Job> JobStore::list(const JobFilter& filter) const {
  std::string query = std::string(select_job) + "WHERE id < ? ";
  if (filter.state) query += "AND state = ? ";
  query += "ORDER BY id DESC LIMIT ?";

  const Lock lock(reader_->mutex);
  Statement statement(*reader_, query);
  statement.bind(filter.before_id.value_or("~"));  // behind every id
  if (filter.state) statement.bind(text(*filter.state));
  statement.bind(filter.limit);
  std::vector<Job> jobs;
  while (statement.step()) jobs.push_back(job_of(statement));
  return jobs;
}

/// Inside a transaction: the only place that changes a job's state.
bool JobStore::move(const std::string& id, JobState to) {
  Statement current(*writer_, "SELECT state FROM jobs WHERE id = ?");
  if (!current.bind(id).step()) return false;
  const std::optional<JobState> from = api::job_state(current.text(0));
  if (!from || !api::may_follow(*from, to)) return false;
  const std::int64_t now = options_.clock();
  if (to == JobState::running)
    Statement(*writer_, "UPDATE jobs SET started_ms = COALESCE(started_ms, ?) WHERE id = ?")
        .bind(now, id)
        .run();
  if (api::is_end(to))
    Statement(*writer_, "UPDATE jobs SET finished_ms = ?, eta_seconds = NULL WHERE id = ?")
        .bind(now, id)
        .run();
  Statement(*writer_, "UPDATE jobs SET state = ? WHERE id = ?").bind(text(to), id).run();
  return true;
}

std::optional<Job> JobStore::cancel(const std::string& id) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (move(id, JobState::canceled)) delete_open_tasks(*writer_, id);
  std::optional<Job> job = find_on(*writer_, id);
  transaction.commit();
  return job;
}

bool JobStore::remove(const std::string& id) {
  const Lock lock(writer_->mutex);
  Statement(*writer_, "DELETE FROM jobs WHERE id = ?").bind(id).run();
  return writer_->changes() > 0;
}

std::optional<Task> JobStore::claim_one(const std::string& only_job) {
  const std::int64_t now = options_.clock();
  Statement statement(*writer_, std::string(R"sql(
UPDATE tasks SET state = 'leased', owner = ?, lease_until_ms = ?,
                 fencing_token = fencing_token + 1, attempts = attempts + 1
WHERE (job_id, pass_index) = (
  SELECT job_id, pass_index FROM tasks
  WHERE state <> 'done' AND ((state = 'ready' AND not_before_ms <= ?)
                             OR (state = 'leased' AND lease_until_ms < ?)) )sql") +
                                    (only_job.empty() ? "" : "AND job_id = ? ") +
                                    R"sql(
  ORDER BY job_id, pass_index LIMIT 1)
RETURNING job_id, pass_index, first_sample, sample_count, fencing_token, attempts)sql");
  statement.bind(owner_, now + options_.lease_ms, now, now);
  if (!only_job.empty()) statement.bind(only_job);
  if (!statement.step()) return std::nullopt;
  Task task{statement.text(0),
            {static_cast<std::uint32_t>(statement.integer(1)),
             static_cast<std::uint32_t>(statement.integer(2)),
             static_cast<std::uint32_t>(statement.integer(3))},
            statement.integer(4),
            static_cast<int>(statement.integer(5))};
  statement.run();
  return task;
}

std::optional<Task> JobStore::claim(const std::string& preferred) {
  const Lock lock(writer_->mutex);
  // A claim that is lost to a power cut is made again: nobody was promised anything.
  const sql::UnsyncedCommits unsynced(*writer_);
  Transaction transaction(*writer_);
  std::optional<Task> task;
  if (!preferred.empty()) task = claim_one(preferred);
  if (!task) task = claim_one({});
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
      .bind(options_.clock() + options_.lease_ms, task.job_id, task.pass.index)
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
      .bind(options_.clock() + delay_ms, counts_as_attempt ? 0 : 1, task.job_id, task.pass.index)
      .run();
  move(task.job_id, JobState::queued);
  transaction.commit();
  return true;
}

bool JobStore::complete(const Task& task, const TaskResult& result, const Pass& next) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (!holds(task)) return false;
  Statement(*writer_,
            "UPDATE tasks SET state = 'done', seconds = ? WHERE job_id = ? AND pass_index = ?")
      .bind(result.seconds, task.job_id, task.pass.index)
      .run();
  store_progress(*writer_, task.job_id, result.progress);
  insert_task(*writer_, task.job_id, next);
  transaction.commit();
  return true;
}

bool JobStore::finish(const Task& task, const TaskResult& result, bool with_pass,
                      const std::string& stats, const std::string& image) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (!holds(task)) return false;
  if (with_pass)
    Statement(*writer_,
              "UPDATE tasks SET state = 'done', seconds = ? WHERE job_id = ? AND pass_index = ?")
        .bind(result.seconds, task.job_id, task.pass.index)
        .run();
  delete_open_tasks(*writer_, task.job_id);
  store_progress(*writer_, task.job_id, result.progress);
  Statement(*writer_, "UPDATE jobs SET stats = ?, image = ? WHERE id = ?")
      .bind(stats, image, task.job_id)
      .run();
  if (!move(task.job_id, JobState::succeeded)) return false;
  transaction.commit();
  return true;
}

bool JobStore::fail(const Task& task, const std::string& error) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (!holds(task)) return false;
  delete_open_tasks(*writer_, task.job_id);
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

void JobStore::check_writable() {
  const Lock lock(writer_->mutex);
  Statement(*writer_, "INSERT OR REPLACE INTO probe(id, written_ms) VALUES (1, ?)")
      .bind(options_.clock())
      .run();
}

}  // namespace translucube::server
