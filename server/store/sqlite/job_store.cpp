#include "server/store/job_store.h"

#include <cassert>

#include "server/store/sqlite/job_store_rows.h"
#include "server/store/sqlite/job_store_schema.h"

namespace translucube::server {

using api::JobState;
using rows::Lock;
using rows::text;
using sql::Statement;
using sql::Transaction;

JobStore::JobStore(const std::filesystem::path& file, StoreOptions options)
    : options_(std::move(options)), owner_(random_hex(16)) {
  writer_ = std::make_unique<sql::Connection>(file, sql::Connection::Access::read_write);
  prepare_schema(*writer_, file);

  Transaction transaction(*writer_);
  Statement(*writer_,
            "UPDATE tasks SET state = 'ready', owner = NULL, not_before_ms = 0 "
            "WHERE state <> 'done'")
      .run();
  std::vector<std::string> interrupted;
  Statement running(*writer_, "SELECT id FROM jobs WHERE state = ?");
  running.bind(text(JobState::running));
  while (running.step()) interrupted.push_back(running.text(0));
  for (const std::string& id : interrupted) move(id, JobState::queued);
  Statement newest(*writer_,
                   "SELECT MAX(id) FROM (SELECT MAX(id) AS id FROM jobs UNION ALL "
                   "SELECT MAX(id) FROM sweeps)");
  ids_ = std::make_unique<IdSource>(newest.step() ? newest.text(0) : std::string());
  transaction.commit();

  if (file != ":memory:")
    own_reader_ = std::make_unique<sql::Connection>(file, sql::Connection::Access::read_only);
  reader_ = own_reader_ ? own_reader_.get() : writer_.get();
}

JobStore::~JobStore() = default;

bool JobStore::queue_has_room(std::size_t jobs) {
  Statement open(*writer_, "SELECT COUNT(*) FROM jobs WHERE state IN (?, ?)");
  open.bind(text(JobState::queued), text(JobState::running)).step();
  return static_cast<std::uint64_t>(open.integer(0)) + jobs <= options_.most_queued;
}

void JobStore::insert_pictures(const std::string& id, const std::vector<Picture>& lanes) {
  for (std::size_t lane = 0; lane < lanes.size(); ++lane)
    Statement(*writer_, "INSERT INTO pictures(job_id, lane, point, content) VALUES (?, ?, ?, ?)")
        .bind(id, static_cast<std::int64_t>(lane), lanes[lane].point, lanes[lane].content)
        .run();
}

api::Result<Submitted> JobStore::submit(const NewJob& job) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (job.idempotency_key) {
    Statement same(*writer_, std::string(rows::select_job) + "WHERE idempotency_key = ?");
    if (same.bind(*job.idempotency_key).step()) {
      Job known = rows::job_of(same);
      if (known.request != job.request) return idempotency_mismatch();
      return Submitted{std::move(known), false};
    }
  }
  const std::int64_t now = options_.clock();
  const std::optional<std::string> stats = use_results({{0, job.content}}, now);
  const bool cached = stats.has_value();
  if (!cached && !queue_has_room(1)) return queue_full();
  const std::string id = ids_->next(now);
  Statement(*writer_,
            "INSERT INTO jobs(id, state, request, material, idempotency_key, created_ms, "
            "finished_ms, total_samples, stats, cached) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(id, text(cached ? JobState::succeeded : JobState::queued), job.request, job.material,
            job.idempotency_key, now, cached ? std::optional(now) : std::nullopt, job.total_samples,
            stats, cached ? 1 : 0)
      .run();
  insert_pictures(id, {{0, job.content}});
  if (!cached) rows::insert_task(*writer_, id, job.first_pass, Priority::interactive);
  tell_state(id);
  Submitted submitted{*find_on(*writer_, id), true};
  transaction.commit();
  return submitted;
}

std::optional<Job> JobStore::find_on(sql::Connection& connection, const std::string& id) const {
  Statement statement(connection, std::string(rows::select_job) + "WHERE id = ?");
  if (!statement.bind(id).step()) return std::nullopt;
  return rows::job_of(statement);
}

std::optional<Job> JobStore::find(const std::string& id) const {
  const Lock lock(reader_->mutex);
  return find_on(*reader_, id);
}

std::vector<Job> JobStore::list(const JobFilter& filter) const {
  std::string query = std::string(rows::select_job) + "WHERE sweep_id IS NULL AND id < ? ";
  if (filter.state) query += "AND state = ? ";
  query += "ORDER BY id DESC LIMIT ?";

  const Lock lock(reader_->mutex);
  Statement statement(*reader_, query);
  statement.bind(filter.before_id.value_or("~"));  // behind every id
  if (filter.state) statement.bind(text(*filter.state));
  statement.bind(filter.limit);
  std::vector<Job> jobs;
  while (statement.step()) jobs.push_back(rows::job_of(statement));
  return jobs;
}

/// Inside a transaction: the only place that changes a job's state.
bool JobStore::move(const std::string& id, JobState to) {
  Statement current(*writer_, "SELECT state, sweep_id FROM jobs WHERE id = ?");
  if (!current.bind(id).step()) return false;
  const std::optional<std::string> sweep = current.optional_text(1);
  if (!api::may_follow(rows::state_of(current.text(0)), to)) return false;
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
  tell_state(id);
  if (sweep) follow_sweep(*sweep);
  return true;
}

std::optional<Job> JobStore::cancel(const std::string& id) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  if (move(id, JobState::canceled)) rows::delete_open_tasks(*writer_, id);
  std::optional<Job> job = find_on(*writer_, id);
  transaction.commit();
  return job;
}

std::optional<std::vector<StoredResult>> JobStore::remove(const std::string& id) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  const std::vector<std::string> contents = rows::contents_of(*writer_, "job_id = ?", id);
  Statement(*writer_, "DELETE FROM jobs WHERE id = ?").bind(id).run();
  if (writer_->changes() == 0) return std::nullopt;
  const std::vector<StoredResult> unused = drop_unused_results(contents);
  transaction.commit();
  return unused;
}

std::vector<Picture> JobStore::pictures(const std::string& job_id) const {
  const Lock lock(reader_->mutex);
  Statement statement(*reader_,
                      "SELECT point, content FROM pictures WHERE job_id = ? ORDER BY lane");
  statement.bind(job_id);
  std::vector<Picture> lanes;
  while (statement.step())
    lanes.push_back({static_cast<std::uint32_t>(statement.integer(0)), statement.text(1)});
  return lanes;
}

void JobStore::check_writable() {
  const Lock lock(writer_->mutex);
  Statement(*writer_, "INSERT OR REPLACE INTO probe(id, written_ms) VALUES (1, ?)")
      .bind(options_.clock())
      .run();
}

}  // namespace translucube::server
