#include "server/store/sqlite/sqlite_job_store.h"

#include "server/store/sqlite/rows.h"
#include "server/store/sqlite/schema.h"

namespace translucube::server {

using api::JobState;
using rows::Lock;
using sql::Statement;
using sql::Transaction;

namespace {

constexpr const char* memory_location = ":memory:";

/// The file is there, and prepared, once the writer is.
std::unique_ptr<sql::Connection> open_reader(const std::string& file, sql::Connection& writer) {
  prepare_schema(writer, file);
  if (file == memory_location) return nullptr;
  return std::make_unique<sql::Connection>(file, sql::Connection::Access::read_only);
}

}  // namespace

SqliteJobStore::SqliteJobStore(const std::string& file, StoreOptions options)
    : options_(std::move(options)),
      owner_(random_hex(16)),
      writer_(file, sql::Connection::Access::read_write),
      own_reader_(open_reader(file, writer_)),
      reader_(own_reader_ ? *own_reader_ : writer_),
      checkpointer_(
          own_reader_ ? std::make_unique<sql::Connection>(file, sql::Connection::Access::read_write)
                      : nullptr) {
  Transaction transaction(writer_);
  take_over();
  Statement newest(writer_,
                   "SELECT MAX(id) FROM (SELECT MAX(id) AS id FROM jobs UNION ALL "
                   "SELECT MAX(id) FROM sweeps)");
  ids_ = std::make_unique<IdSource>(newest.step() ? newest.text(0) : std::string());
  transaction.commit();
}

std::optional<Job> SqliteJobStore::find(const std::string& id) const {
  const Lock lock(reader_.mutex);
  return rows::find<Job>(reader_, "id = ?", id);
}

std::optional<StoredSweep> SqliteJobStore::find_sweep(const std::string& id) const {
  const Lock lock(reader_.mutex);
  return rows::find<StoredSweep>(reader_, "id = ?", id);
}

std::vector<Job> SqliteJobStore::list(const JobFilter& filter) const {
  const Lock lock(reader_.mutex);
  return rows::page<Job>(reader_, "sweep_id IS NULL", filter);
}

std::vector<StoredSweep> SqliteJobStore::list_sweeps(const JobFilter& filter) const {
  const Lock lock(reader_.mutex);
  return rows::page<StoredSweep>(reader_, "TRUE", filter);
}

std::vector<Picture> SqliteJobStore::pictures(const std::string& job_id) const {
  const Lock lock(reader_.mutex);
  return rows::pictures(reader_, job_id);
}

std::vector<SweepImageState> SqliteJobStore::sweep_images(const std::string& sweep_id) const {
  const Lock lock(reader_.mutex);
  Statement statement(reader_,
                      "SELECT id, point, state, stats, error, cached FROM jobs JOIN pictures "
                      "ON job_id = id WHERE sweep_id = ? ORDER BY image_index, lane");
  statement.bind(sweep_id);
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

std::optional<PointPicture> SqliteJobStore::picture_of_point(const std::string& sweep_id,
                                                             std::uint32_t point) const {
  const Lock lock(reader_.mutex);
  Statement statement(reader_,
                      "SELECT state, content FROM jobs JOIN pictures ON job_id = id "
                      "WHERE sweep_id = ? AND point = ?");
  if (!statement.bind(sweep_id, point).step()) return std::nullopt;
  return PointPicture{rows::state_of(statement.text(0)), statement.text(1)};
}

std::optional<std::vector<StoredResult>> SqliteJobStore::remove(const std::string& id) {
  Transaction transaction(writer_);
  std::vector<std::string> contents;
  Statement statement(writer_,
                      "SELECT DISTINCT content FROM pictures WHERE job_id IN "
                      "(SELECT id FROM jobs WHERE id = ?1 OR sweep_id = ?1)");
  statement.bind(id);
  while (statement.step()) contents.push_back(statement.text(0));
  Statement(
      writer_,
      "INSERT OR IGNORE INTO leftovers SELECT id, '' FROM jobs WHERE id = ?1 OR sweep_id = ?1 "
      "UNION ALL SELECT id, '' FROM sweeps WHERE id = ?1")
      .bind(id)
      .run();
  Statement(writer_, "DELETE FROM jobs WHERE id = ?1 OR sweep_id = ?1").bind(id).run();
  const int jobs = writer_.changes();
  Statement(writer_, "DELETE FROM sweeps WHERE id = ?").bind(id).run();
  if (jobs + writer_.changes() == 0) return std::nullopt;
  std::vector<StoredResult> unused = drop_unused_results(contents);
  transaction.commit();
  return unused;
}

std::vector<std::string> SqliteJobStore::ended_before(std::int64_t time_ms, int most) const {
  const Lock lock(reader_.mutex);
  Statement statement(reader_,
                      "SELECT id, finished_ms FROM jobs WHERE sweep_id IS NULL AND "
                      "finished_ms IS NOT NULL AND finished_ms < ?1 UNION ALL "
                      "SELECT id, finished_ms FROM sweeps WHERE finished_ms IS NOT NULL AND "
                      "finished_ms < ?1 ORDER BY finished_ms LIMIT ?2");
  statement.bind(time_ms, most);
  std::vector<std::string> ids;
  while (statement.step()) ids.push_back(statement.text(0));
  return ids;
}

void SqliteJobStore::checkpoint() {
  if (!checkpointer_) return;
  const Lock lock(checkpointer_->mutex);
  checkpointer_->execute("PRAGMA wal_checkpoint(PASSIVE)");
}

void SqliteJobStore::check_writable() {
  const Lock lock(writer_.mutex);
  Statement(writer_, "INSERT OR REPLACE INTO probe(id, written_ms) VALUES (1, ?)")
      .bind(options_.clock())
      .run();
}

}  // namespace translucube::server
