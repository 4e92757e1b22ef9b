#include <algorithm>

#include "api/answer/event.h"
#include "server/store/sqlite/job_store_rows.h"

namespace translucube::server {

using api::JobState;
using rows::Lock;
using rows::text;
using sql::Statement;
using sql::Transaction;

namespace {

constexpr const char* select_sweep =
    "SELECT id, state, request, created_ms, started_ms, finished_ms, points, images FROM sweeps ";

StoredSweep sweep_of(const Statement& row) {
  return {row.text(0),
          rows::state_of(row.text(1)),
          row.text(2),
          row.integer(3),
          row.optional_integer(4),
          row.optional_integer(5),
          static_cast<std::uint32_t>(row.integer(6)),
          static_cast<std::uint32_t>(row.integer(7))};
}

}  // namespace

api::Result<SubmittedSweep> JobStore::submit(const NewSweep& sweep) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  const std::int64_t now = options_.clock();
  if (sweep.idempotency_key) {
    Statement same(*writer_, std::string(select_sweep) + "WHERE idempotency_key = ?");
    if (same.bind(*sweep.idempotency_key).step()) {
      StoredSweep known = sweep_of(same);
      if (known.request != sweep.request) return idempotency_mismatch();
      return SubmittedSweep{std::move(known), false};
    }
  }
  std::vector<std::optional<std::string>> made;
  for (const auto& lanes : sweep.images) made.push_back(use_results(lanes, now));
  const auto missing = static_cast<std::size_t>(
      std::ranges::count_if(made, [](const auto& stats) { return !stats; }));
  if (missing > 0 && !queue_has_room(missing)) return queue_full();
  const std::string id = ids_->next(now);
  std::size_t points = 0;
  for (const auto& lanes : sweep.images) points += lanes.size();
  Statement(*writer_,
            "INSERT INTO sweeps(id, state, request, idempotency_key, created_ms, points, images) "
            "VALUES (?, ?, ?, ?, ?, ?, ?)")
      .bind(id, text(JobState::queued), sweep.request, sweep.idempotency_key, now,
            static_cast<std::int64_t>(points), static_cast<std::int64_t>(sweep.images.size()))
      .run();
  std::vector<std::uint32_t> there;
  for (std::size_t image = 0; image < sweep.images.size(); ++image) {
    const std::string job = ids_->next(now);
    const bool cached = made[image].has_value();
    Statement(*writer_,
              "INSERT INTO jobs(id, state, request, material, created_ms, finished_ms, "
              "total_samples, stats, cached, sweep_id, image_index, points) "
              "VALUES (?, ?, '', '', ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(job, text(cached ? JobState::succeeded : JobState::queued), now,
              cached ? std::optional(now) : std::nullopt, sweep.total_samples, made[image],
              cached ? 1 : 0, id, static_cast<std::int64_t>(image),
              static_cast<std::int64_t>(sweep.images[image].size()))
        .run();
    insert_pictures(job, sweep.images[image]);
    if (!cached) rows::insert_task(*writer_, job, sweep.first_pass, Priority::batch);
    for (const Picture& picture : sweep.images[image])
      if (cached) there.push_back(picture.point);
  }
  const api::StateCounts counts = rows::point_counts(*writer_, id);
  tell(id, "state", api::sweep_event(JobState::queued, counts));
  if (!there.empty()) {
    tell(id, "points", api::points_event(there, JobState::succeeded, counts));
    follow_sweep(id);
  }
  SubmittedSweep submitted{*find_sweep_on(*writer_, id), true};
  transaction.commit();
  return submitted;
}

std::optional<StoredSweep> JobStore::find_sweep_on(sql::Connection& connection,
                                                   const std::string& id) const {
  Statement statement(connection, std::string(select_sweep) + "WHERE id = ?");
  if (!statement.bind(id).step()) return std::nullopt;
  return sweep_of(statement);
}

std::optional<StoredSweep> JobStore::find_sweep(const std::string& id) const {
  const Lock lock(reader_->mutex);
  return find_sweep_on(*reader_, id);
}

std::vector<StoredSweep> JobStore::list_sweeps(const JobFilter& filter) const {
  std::string query = std::string(select_sweep) + "WHERE id < ? ";
  if (filter.state) query += "AND state = ? ";
  query += "ORDER BY id DESC LIMIT ?";
  const Lock lock(reader_->mutex);
  Statement statement(*reader_, query);
  statement.bind(filter.before_id.value_or("~"));  // behind every id
  if (filter.state) statement.bind(text(*filter.state));
  statement.bind(filter.limit);
  std::vector<StoredSweep> sweeps;
  while (statement.step()) sweeps.push_back(sweep_of(statement));
  return sweeps;
}

std::vector<SweepImageState> JobStore::sweep_images(const std::string& id) const {
  const Lock lock(reader_->mutex);
  Statement statement(*reader_,
                      "SELECT id, point, state, stats, error, cached FROM jobs JOIN pictures "
                      "ON job_id = id WHERE sweep_id = ? ORDER BY image_index, lane");
  statement.bind(id);
  std::vector<SweepImageState> images;
  while (statement.step()) {
    if (images.empty() || images.back().job_id != statement.text(0))
      images.push_back({statement.text(0),
                        rows::state_of(statement.text(2)),
                        statement.optional_text(3),
                        statement.optional_text(4),
                        statement.integer(5) != 0,
                        {}});
    images.back().points.push_back(static_cast<std::uint32_t>(statement.integer(1)));
  }
  return images;
}

std::optional<JobStore::PointPicture> JobStore::picture_of_point(const std::string& id,
                                                                 std::uint32_t point) const {
  const Lock lock(reader_->mutex);
  Statement statement(*reader_,
                      "SELECT state, content FROM jobs JOIN pictures ON job_id = id "
                      "WHERE sweep_id = ? AND point = ?");
  if (!statement.bind(id, point).step()) return std::nullopt;
  return PointPicture{rows::state_of(statement.text(0)), statement.text(1)};
}

/// Inside a transaction, after one of its jobs has moved: tells what became of the points, and
/// moves the sweep. It has succeeded when all its images have ended and one of them has succeeded.
void JobStore::follow_sweep(const std::string& id) {
  const std::optional<StoredSweep> sweep = find_sweep_on(*writer_, id);
  if (!sweep || api::is_end(sweep->state)) return;
  const api::StateCounts counts = rows::point_counts(*writer_, id);
  const auto count = [&](JobState state) { return counts[static_cast<std::size_t>(state)]; };
  JobState to = sweep->state;
  if (count(JobState::queued) + count(JobState::running) == 0)
    to = count(JobState::succeeded) > 0 ? JobState::succeeded
         : count(JobState::failed) > 0  ? JobState::failed
                                        : JobState::canceled;
  else if (count(JobState::queued) < sweep->points)
    to = JobState::running;
  if (to == sweep->state) return;
  const std::int64_t now = options_.clock();
  Statement(*writer_,
            "UPDATE sweeps SET state = ?, started_ms = COALESCE(started_ms, ?), finished_ms = ? "
            "WHERE id = ?")
      .bind(text(to), now, api::is_end(to) ? std::optional(now) : std::nullopt, id)
      .run();
  tell(id, "state", api::sweep_event(to, counts));
}

std::optional<StoredSweep> JobStore::cancel_sweep(const std::string& id) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  std::optional<StoredSweep> sweep = find_sweep_on(*writer_, id);
  if (!sweep || api::is_end(sweep->state)) return sweep;
  Statement(*writer_,
            "DELETE FROM tasks WHERE state <> 'done' AND job_id IN "
            "(SELECT id FROM jobs WHERE sweep_id = ?)")
      .bind(id)
      .run();
  const std::int64_t now = options_.clock();
  Statement(*writer_,
            "UPDATE jobs SET state = ?, finished_ms = ?, eta_seconds = NULL "
            "WHERE sweep_id = ? AND state IN (?, ?)")
      .bind(text(JobState::canceled), now, id, text(JobState::queued), text(JobState::running))
      .run();
  Statement(*writer_, "UPDATE sweeps SET state = ?, finished_ms = ? WHERE id = ?")
      .bind(text(JobState::canceled), now, id)
      .run();
  tell(id, "state", api::sweep_event(JobState::canceled, rows::point_counts(*writer_, id)));
  sweep = find_sweep_on(*writer_, id);
  transaction.commit();
  return sweep;
}

std::optional<std::vector<StoredResult>> JobStore::remove_sweep(const std::string& id) {
  const Lock lock(writer_->mutex);
  Transaction transaction(*writer_);
  const std::vector<std::string> contents =
      rows::contents_of(*writer_, "job_id IN (SELECT id FROM jobs WHERE sweep_id = ?)", id);
  Statement(*writer_, "DELETE FROM jobs WHERE sweep_id = ?").bind(id).run();
  Statement(*writer_, "DELETE FROM sweeps WHERE id = ?").bind(id).run();
  if (writer_->changes() == 0) return std::nullopt;
  const std::vector<StoredResult> unused = drop_unused_results(contents);
  transaction.commit();
  return unused;
}

}  // namespace translucube::server
