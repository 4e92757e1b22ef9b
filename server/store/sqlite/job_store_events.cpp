#include <algorithm>

#include "api/answer/event.h"
#include "server/store/sqlite/job_store_rows.h"

namespace translucube::server {

using api::JobState;
using rows::Lock;
using sql::Statement;

void JobStore::tell(const std::string& subject, const std::string& type, const std::string& data) {
  Statement(*writer_,
            "INSERT INTO events(subject, number, type, data) VALUES (?1, "
            "(SELECT COALESCE(MAX(number), 0) + 1 FROM events WHERE subject = ?1), ?2, ?3)")
      .bind(subject, type, data)
      .run();
}

/// Inside a transaction: a render's own state, or what became of the points of a sweep's image.
void JobStore::tell_state(const std::string& id) {
  const std::optional<Job> job = find_on(*writer_, id);
  if (!job) return;
  if (!job->sweep_image) {
    tell(id, "state", api::state_event(job->state, job->progress, job->error));
    return;
  }
  Statement points(*writer_, "SELECT point FROM pictures WHERE job_id = ? ORDER BY lane");
  points.bind(id);
  std::vector<std::uint32_t> numbers;
  while (points.step()) numbers.push_back(static_cast<std::uint32_t>(points.integer(0)));
  tell(job->sweep_image->sweep_id, "points",
       api::points_event(numbers, job->state,
                         rows::point_counts(*writer_, job->sweep_image->sweep_id)));
}

std::vector<Event> JobStore::events_after(const std::string& subject, std::uint64_t number) const {
  const Lock lock(reader_->mutex);
  Statement statement(*reader_,
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

QueueGauges JobStore::gauges() const {
  const Lock lock(reader_->mutex);
  QueueGauges gauges;
  const auto count = [&](auto& counts, const std::string& query) {
    Statement statement(*reader_, query);
    while (statement.step())
      counts[static_cast<std::size_t>(rows::state_of(statement.text(0)))] =
          static_cast<std::uint64_t>(statement.integer(1));
  };
  count(gauges.jobs, "SELECT state, COUNT(*) FROM jobs GROUP BY state");
  count(gauges.sweeps, "SELECT state, COUNT(*) FROM sweeps GROUP BY state");
  Statement waiting(*reader_,
                    "SELECT priority, COUNT(*) FROM tasks WHERE state <> 'done' AND "
                    "state = 'ready' GROUP BY priority");
  while (waiting.step())
    gauges.waiting_tasks.at(static_cast<std::size_t>(waiting.integer(0))) =
        static_cast<std::uint64_t>(waiting.integer(1));
  Statement oldest(*reader_, "SELECT MIN(created_ms) FROM jobs WHERE state = ?");
  oldest.bind(rows::text(JobState::queued));
  if (oldest.step() && !oldest.is_null(0))
    gauges.oldest_waiting_s = std::max(0.0, double(options_.clock() - oldest.integer(0)) / 1000);
  Statement results(*reader_, "SELECT COUNT(*), COALESCE(SUM(bytes), 0) FROM results");
  if (results.step()) {
    gauges.results = static_cast<std::uint64_t>(results.integer(0));
    gauges.result_bytes = static_cast<std::uint64_t>(results.integer(1));
  }
  return gauges;
}

}  // namespace translucube::server
