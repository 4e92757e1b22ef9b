#include <algorithm>

#include "api/answer/event.h"
#include "server/store/sqlite/rows.h"
#include "server/store/sqlite/sqlite_job_store.h"
#include "server/store/sweep_state.h"

namespace translucube::server {

using api::JobState;
using rows::Lock;
using sql::Statement;
using sql::Transaction;

/// The only place that changes a job's state.
bool SqliteJobStore::move(const std::string& id, JobState to) {
  Statement current(writer_, "SELECT state, sweep_id FROM jobs WHERE id = ?");
  if (!current.bind(id).step()) return false;
  const std::optional<std::string> sweep = current.optional_text(1);
  if (!api::may_follow(rows::state_of(current.text(0)), to)) return false;
  const std::int64_t now = options_.clock();
  if (to == JobState::running)
    Statement(writer_, "UPDATE jobs SET started_ms = COALESCE(started_ms, ?) WHERE id = ?")
        .bind(now, id)
        .run();
  if (api::is_end(to))
    Statement(writer_,
              "UPDATE jobs SET finished_ms = ?, eta_seconds = NULL, suspect = 0 WHERE id = ?")
        .bind(now, id)
        .run();
  Statement(writer_, "UPDATE jobs SET state = ? WHERE id = ?").bind(rows::text(to), id).run();
  tell_state(id);
  if (sweep) follow_sweep(*sweep);
  return true;
}

/// After one of its jobs has moved: moves the sweep.
void SqliteJobStore::follow_sweep(const std::string& sweep_id) {
  const auto sweep = rows::find<StoredSweep>(writer_, "id = ?", sweep_id);
  if (!sweep || api::is_end(sweep->state)) return;
  const api::StateCounts counts = rows::point_counts(writer_, sweep_id);
  const JobState to = sweep_state(sweep->state, counts);
  if (to == sweep->state) return;
  const std::int64_t now = options_.clock();
  Statement(writer_,
            "UPDATE sweeps SET state = ?, started_ms = COALESCE(started_ms, ?), finished_ms = ? "
            "WHERE id = ?")
      .bind(rows::text(to), now, api::is_end(to) ? std::optional(now) : std::nullopt, sweep_id)
      .run();
  tell(sweep_id, "state", api::sweep_event(to, counts));
}

void SqliteJobStore::cancel(const std::string& id) {
  Transaction transaction(writer_);
  const bool moved = move(id, JobState::canceled);
  const auto sweep = moved ? std::nullopt : rows::find<StoredSweep>(writer_, "id = ?", id);
  if (sweep && !api::is_end(sweep->state)) cancel_sweep(id);
  rows::delete_open_tasks(writer_, id);
  transaction.commit();
}

/// All its jobs at once, which is told once.
void SqliteJobStore::cancel_sweep(const std::string& id) {
  const std::int64_t now = options_.clock();
  const std::string canceled = rows::text(JobState::canceled);
  Statement(writer_,
            "UPDATE jobs SET state = ?, finished_ms = ?, eta_seconds = NULL, suspect = 0 "
            "WHERE sweep_id = ? AND state IN (?, ?)")
      .bind(canceled, now, id, rows::text(JobState::queued), rows::text(JobState::running))
      .run();
  Statement(writer_, "UPDATE sweeps SET state = ?, finished_ms = ? WHERE id = ?")
      .bind(canceled, now, id)
      .run();
  tell(id, "state", api::sweep_event(JobState::canceled, rows::point_counts(writer_, id)));
}

void SqliteJobStore::tell(const std::string& subject, const std::string& type,
                          const std::string& data) {
  Statement(writer_,
            "INSERT INTO events(subject, number, type, data) VALUES (?1, "
            "(SELECT COALESCE(MAX(number), 0) + 1 FROM events WHERE subject = ?1), ?2, ?3)")
      .bind(subject, type, data)
      .run();
}

/// A render's own state, or what became of the points of a sweep's image.
void SqliteJobStore::tell_state(const std::string& id) {
  const auto job = rows::find<Job>(writer_, "id = ?", id);
  if (!job) return;
  if (!job->sweep_image) {
    tell(id, "state", api::state_event(job->state, job->progress, job->error));
    return;
  }
  std::vector<std::uint32_t> points;
  for (const Picture& lane : rows::pictures(writer_, id)) points.push_back(lane.point);
  const std::string& sweep = job->sweep_image->sweep_id;
  tell(sweep, "points", api::points_event(points, job->state, rows::point_counts(writer_, sweep)));
}

std::vector<Event> SqliteJobStore::events_after(const std::string& subject,
                                                std::uint64_t number) const {
  const Lock lock(reader_.mutex);
  Statement statement(reader_,
                      "SELECT number, type, data FROM events WHERE subject = ? AND number > ? "
                      "ORDER BY number");
  statement.bind(
      subject, static_cast<std::int64_t>(std::min<std::uint64_t>(number, std::uint64_t{1} << 62)));
  std::vector<Event> events;
  while (statement.step())
    events.push_back(
        {static_cast<std::uint64_t>(statement.integer(0)), statement.text(1), statement.text(2)});
  return events;
}

std::uint64_t SqliteJobStore::last_event(const std::string& subject) const {
  const Lock lock(reader_.mutex);
  Statement statement(reader_, "SELECT COALESCE(MAX(number), 0) FROM events WHERE subject = ?");
  return statement.bind(subject).step() ? static_cast<std::uint64_t>(statement.integer(0)) : 0;
}

OpenNeeds SqliteJobStore::open_needs() const {
  const Lock lock(reader_.mutex);
  Statement sum(reader_,
                "SELECT COALESCE(SUM(picture_bytes), 0), COALESCE(MAX(picture_bytes), 0) FROM jobs "
                "WHERE state IN ('queued', 'running')");
  if (!sum.step()) return {};
  return {static_cast<std::uint64_t>(sum.integer(0)), static_cast<std::uint64_t>(sum.integer(1))};
}

QueueGauges SqliteJobStore::gauges() const {
  const Lock lock(reader_.mutex);
  QueueGauges gauges;
  const auto count = [&](auto& counts, const std::string& query) {
    Statement statement(reader_, query);
    while (statement.step())
      counts[static_cast<std::size_t>(rows::state_of(statement.text(0)))] =
          static_cast<std::uint64_t>(statement.integer(1));
  };
  count(gauges.jobs, "SELECT state, COUNT(*) FROM jobs GROUP BY state");
  count(gauges.sweeps, "SELECT state, COUNT(*) FROM sweeps GROUP BY state");
  Statement waiting(reader_,
                    "SELECT priority, COUNT(*) FROM tasks WHERE state <> 'done' AND "
                    "state = 'ready' GROUP BY priority");
  while (waiting.step())
    gauges.waiting_tasks.at(static_cast<std::size_t>(waiting.integer(0))) =
        static_cast<std::uint64_t>(waiting.integer(1));
  Statement oldest(reader_, "SELECT MIN(created_ms) FROM jobs WHERE state = ?");
  oldest.bind(rows::text(JobState::queued));
  if (oldest.step() && !oldest.is_null(0))
    gauges.oldest_waiting_s = std::max(0.0, double(options_.clock() - oldest.integer(0)) / 1000);
  Statement results(reader_, "SELECT COUNT(*), COALESCE(SUM(bytes), 0) FROM results");
  if (results.step()) {
    gauges.results = static_cast<std::uint64_t>(results.integer(0));
    gauges.result_bytes = static_cast<std::uint64_t>(results.integer(1));
  }
  return gauges;
}

}  // namespace translucube::server
