#include <algorithm>

#include "server/store/refusals.h"
#include "server/store/sqlite/rows.h"
#include "server/store/sqlite/sqlite_job_store.h"

namespace translucube::server {

using api::JobState;
using rows::text;
using sql::Statement;
using sql::Transaction;

namespace {

/// What the key was used for before, if it was.
template <typename Stored, typename Asked>
std::optional<api::Result<Submitted<Stored>>> submitted_before(sql::Connection& writer,
                                                               const Asked& asked) {
  if (!asked.idempotency_key) return std::nullopt;
  auto known = rows::find<Stored>(writer, "idempotency_key = ?", *asked.idempotency_key);
  if (!known) return std::nullopt;
  if (known->request != asked.request) return idempotency_mismatch();
  return Submitted<Stored>{std::move(*known), false};
}

}  // namespace

struct SqliteJobStore::NewRow {
  std::string request, material;  ///< a render's
  std::optional<std::string> idempotency_key;
  std::int64_t now = 0;
  std::optional<std::uint32_t> total_samples;
  std::optional<std::string> stats;  ///< of its results, where all are there
  std::optional<SweepImage> sweep_image;
  const std::vector<Picture>& lanes;
  Pass first_pass;
  std::uint64_t picture_bytes = 0;
};

/// A render or an image of a sweep with its pictures, and its first task unless it is done; its id.
std::string SqliteJobStore::insert_job(const NewRow& row) {
  const std::string id = ids_->next(row.now);
  const bool cached = row.stats.has_value();
  const auto& sweep = row.sweep_image;
  Statement(writer_,
            "INSERT INTO jobs(id, state, request, material, idempotency_key, created_ms, "
            "finished_ms, total_samples, stats, cached, sweep_id, image_index, points, "
            "picture_bytes) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(id, text(cached ? JobState::succeeded : JobState::queued), row.request, row.material,
            row.idempotency_key, row.now, cached ? std::optional(row.now) : std::nullopt,
            row.total_samples, row.stats, cached ? 1 : 0,
            sweep ? std::optional(sweep->sweep_id) : std::nullopt, sweep ? sweep->index : 0,
            static_cast<std::int64_t>(row.lanes.size()),
            static_cast<std::int64_t>(row.picture_bytes))
      .run();
  for (std::size_t lane = 0; lane < row.lanes.size(); ++lane)
    Statement(writer_, "INSERT INTO pictures(job_id, lane, point, content) VALUES (?, ?, ?, ?)")
        .bind(id, static_cast<std::int64_t>(lane), row.lanes[lane].point, row.lanes[lane].content)
        .run();
  if (!cached)
    rows::insert_task(writer_, id, row.first_pass, sweep ? Priority::batch : Priority::interactive);
  return id;
}

bool SqliteJobStore::queue_has_room(std::size_t jobs) {
  Statement open(writer_, "SELECT COUNT(*) FROM jobs WHERE state IN (?, ?)");
  open.bind(text(JobState::queued), text(JobState::running)).step();
  return static_cast<std::uint64_t>(open.integer(0)) + jobs <= options_.most_queued;
}

api::Result<Submitted<Job>> SqliteJobStore::submit(const NewJob& job) {
  Transaction transaction(writer_);
  if (auto known = submitted_before<Job>(writer_, job)) return std::move(*known);
  const std::int64_t now = options_.clock();
  const std::vector<Picture> lanes{{0, job.content}};
  const std::optional<std::string> stats = use_results(lanes, now);
  if (!stats && !queue_has_room(1)) return queue_full();
  const std::string id =
      insert_job({job.request, job.material, job.idempotency_key, now, job.total_samples, stats,
                  std::nullopt, lanes, job.first_pass, job.picture_bytes});
  tell_state(id);
  Submitted<Job> submitted{rows::find<Job>(writer_, "id = ?", id).value(), true};
  transaction.commit();
  return submitted;
}

api::Result<Submitted<StoredSweep>> SqliteJobStore::submit(const NewSweep& sweep) {
  Transaction transaction(writer_);
  if (auto known = submitted_before<StoredSweep>(writer_, sweep)) return std::move(*known);
  const std::int64_t now = options_.clock();
  std::vector<std::optional<std::string>> made;
  std::size_t missing = 0, points = 0;
  for (const std::vector<Picture>& lanes : sweep.images) {
    made.push_back(use_results(lanes, now));
    missing += made.back() ? 0 : 1;
    points += lanes.size();
  }
  if (missing > 0 && !queue_has_room(missing)) return queue_full();
  const std::string id = ids_->next(now);
  Statement(writer_,
            "INSERT INTO sweeps(id, state, request, idempotency_key, created_ms, points, images) "
            "VALUES (?, ?, ?, ?, ?, ?, ?)")
      .bind(id, text(JobState::queued), sweep.request, sweep.idempotency_key, now,
            static_cast<std::int64_t>(points), static_cast<std::int64_t>(sweep.images.size()))
      .run();
  std::vector<std::uint32_t> there;
  for (std::uint32_t image = 0; image < sweep.images.size(); ++image) {
    const std::vector<Picture>& lanes = sweep.images[image];
    insert_job({"", "", std::nullopt, now, sweep.total_samples, made[image], SweepImage{id, image},
                lanes, sweep.first_pass, lanes.size() * sweep.picture_bytes});
    if (made[image]) std::ranges::transform(lanes, std::back_inserter(there), &Picture::point);
  }
  const api::StateCounts counts = rows::point_counts(writer_, id);
  tell(id, "state", api::sweep_event(JobState::queued, counts));
  if (!there.empty()) {
    tell(id, "points", api::points_event(there, JobState::succeeded, counts));
    follow_sweep(id);
  }
  Submitted<StoredSweep> submitted{rows::find<StoredSweep>(writer_, "id = ?", id).value(), true};
  transaction.commit();
  return submitted;
}

}  // namespace translucube::server
