#include "server/store/sqlite/rows.h"
#include "server/store/sqlite/sqlite_job_store.h"

namespace translucube::server {

using rows::Lock;
using sql::Statement;
using sql::Transaction;

namespace {

// A last use that is known to the minute serves: each update is a write to the disk.
constexpr std::int64_t use_grain_ms = 60'000;

}  // namespace

std::optional<StoredResult> SqliteJobStore::find_result(const std::string& content) const {
  const Lock lock(reader_.mutex);
  return rows::find<StoredResult>(reader_, "content = ?", content);
}

/// Inside a transaction: the stats of the first picture if all are there, which are used now: they
/// were asked for again.
std::optional<std::string> SqliteJobStore::use_results(const std::vector<Picture>& lanes,
                                                       std::int64_t now) {
  std::optional<std::string> stats;
  for (const Picture& lane : lanes) {
    Statement made(writer_, "SELECT stats FROM results WHERE content = ?");
    if (!made.bind(lane.content).step()) return std::nullopt;
    if (!stats) stats = made.text(0);
  }
  for (const Picture& lane : lanes)
    Statement(writer_, "UPDATE results SET used_ms = ? WHERE content = ?")
        .bind(now, lane.content)
        .run();
  return stats;
}

void SqliteJobStore::touch_result(const std::string& content) {
  const std::int64_t now = options_.clock();
  {
    const Lock lock(reader_.mutex);
    Statement fresh(reader_, "SELECT 1 FROM results WHERE content = ? AND used_ms > ?");
    if (fresh.bind(content, now - use_grain_ms).step()) return;
  }
  const Lock lock(writer_.mutex);
  Statement(writer_, "UPDATE results SET used_ms = ? WHERE content = ?").bind(now, content).run();
}

void SqliteJobStore::resize_result(const std::string& content, std::uint64_t bytes) {
  const Lock lock(writer_.mutex);
  Statement(writer_, "UPDATE results SET bytes = ? WHERE content = ?")
      .bind(static_cast<std::int64_t>(bytes), content)
      .run();
}

bool SqliteJobStore::remove_result(const StoredResult& result) {
  Transaction transaction(writer_);
  Statement(writer_, "DELETE FROM results WHERE content = ? AND image = ?")
      .bind(result.content, result.image)
      .run();
  if (writer_.changes() == 0) return false;
  leave_over({result.content, result.image});
  transaction.commit();
  return true;
}

void SqliteJobStore::lose_result(const StoredResult& result) {
  const Lock lock(writer_.mutex);
  Statement(writer_, "DELETE FROM results WHERE content = ? AND image = ?")
      .bind(result.content, result.image)
      .run();
}

void SqliteJobStore::leave_over(const Leftover& removed) {
  Statement(writer_, "INSERT OR IGNORE INTO leftovers(folder, image) VALUES (?, ?)")
      .bind(removed.folder, removed.image)
      .run();
}

std::vector<Leftover> SqliteJobStore::leftovers() const {
  const Lock lock(reader_.mutex);
  Statement statement(reader_, "SELECT folder, image FROM leftovers");
  std::vector<Leftover> all;
  while (statement.step()) all.push_back({statement.text(0), statement.text(1)});
  return all;
}

void SqliteJobStore::forget(const Leftover& removed) {
  // Lost to a power cut, it is looked for again, and not found.
  Transaction transaction(writer_, sql::Durability::process);
  Statement(writer_, "DELETE FROM leftovers WHERE folder = ? AND image = ?")
      .bind(removed.folder, removed.image)
      .run();
  transaction.commit();
}

void SqliteJobStore::insert_results(const std::vector<StoredResult>& results) {
  for (const StoredResult& made : results)
    Statement(writer_,
              "INSERT OR IGNORE INTO results(content, image, image_bytes, stats, bytes, used_ms) "
              "VALUES (?, ?, ?, ?, ?, ?)")
        .bind(made.content, made.image,
              made.image_bytes ? std::optional(static_cast<std::int64_t>(*made.image_bytes))
                               : std::nullopt,
              made.stats, static_cast<std::int64_t>(made.bytes), options_.clock())
        .run();
}

std::vector<StoredResult> SqliteJobStore::drop_unused_results(
    const std::vector<std::string>& contents) {
  std::vector<StoredResult> unused;
  for (const std::string& content : contents) {
    auto result = rows::find<StoredResult>(
        writer_, "content = ?1 AND NOT EXISTS (SELECT 1 FROM pictures WHERE pictures.content = ?1)",
        content);
    if (!result) continue;
    leave_over({content, result->image});
    unused.push_back(std::move(*result));
    Statement(writer_, "DELETE FROM results WHERE content = ?").bind(content).run();
  }
  return unused;
}

std::vector<StoredResult> SqliteJobStore::least_recently_used(std::uint64_t bytes) const {
  const Lock lock(reader_.mutex);
  Statement statement(reader_,
                      std::string(rows::Query<StoredResult>::select) + "ORDER BY used_ms, content");
  std::vector<StoredResult> oldest;
  for (std::uint64_t sum = 0; sum < bytes && statement.step(); sum += oldest.back().bytes)
    oldest.push_back(rows::Query<StoredResult>::read(statement));
  return oldest;
}

std::uint64_t SqliteJobStore::result_bytes() const {
  const Lock lock(reader_.mutex);
  Statement sum(reader_, "SELECT COALESCE(SUM(bytes), 0) FROM results");
  return sum.step() ? static_cast<std::uint64_t>(sum.integer(0)) : 0;
}

}  // namespace translucube::server
