#include "server/store/sqlite/job_store_rows.h"

namespace translucube::server {

using rows::Lock;
using sql::Statement;
using sql::Transaction;

namespace {

constexpr const char* select_result =
    "SELECT content, image, image_bytes, bytes, stats FROM results ";

StoredResult result_of(const Statement& row) {
  StoredResult result{
      row.text(0), row.text(1), {}, static_cast<std::uint64_t>(row.integer(3)), row.text(4)};
  if (const auto bytes = row.optional_integer(2))
    result.image_bytes = static_cast<std::uint64_t>(*bytes);
  return result;
}

// A last use that is known to the minute serves: each update is a write to the disk.
constexpr std::int64_t use_grain_ms = 60'000;

}  // namespace

std::optional<StoredResult> JobStore::find_result(const std::string& content) const {
  const Lock lock(reader_->mutex);
  Statement statement(*reader_, std::string(select_result) + "WHERE content = ?");
  if (!statement.bind(content).step()) return std::nullopt;
  return result_of(statement);
}

/// Inside a transaction: the stats of the first picture if all are there, which are used now: they
/// were asked for again.
std::optional<std::string> JobStore::use_results(const std::vector<Picture>& lanes,
                                                 std::int64_t now) {
  std::optional<std::string> stats;
  for (const Picture& lane : lanes) {
    Statement made(*writer_, "SELECT stats FROM results WHERE content = ?");
    if (!made.bind(lane.content).step()) return std::nullopt;
    if (!stats) stats = made.text(0);
  }
  for (const Picture& lane : lanes)
    Statement(*writer_, "UPDATE results SET used_ms = ? WHERE content = ?")
        .bind(now, lane.content)
        .run();
  return stats;
}

void JobStore::touch_result(const std::string& content) {
  const std::int64_t now = options_.clock();
  {
    const Lock lock(reader_->mutex);
    Statement fresh(*reader_, "SELECT 1 FROM results WHERE content = ? AND used_ms > ?");
    if (fresh.bind(content, now - use_grain_ms).step()) return;
  }
  const Lock lock(writer_->mutex);
  Statement(*writer_, "UPDATE results SET used_ms = ? WHERE content = ?").bind(now, content).run();
}

void JobStore::resize_result(const std::string& content, std::uint64_t bytes) {
  const Lock lock(writer_->mutex);
  Statement(*writer_, "UPDATE results SET bytes = ? WHERE content = ?")
      .bind(static_cast<std::int64_t>(bytes), content)
      .run();
}

bool JobStore::remove_result(const StoredResult& result) {
  const Lock lock(writer_->mutex);
  Statement(*writer_, "DELETE FROM results WHERE content = ? AND image = ?")
      .bind(result.content, result.image)
      .run();
  return writer_->changes() > 0;
}

std::vector<StoredResult> JobStore::drop_unused_results(const std::vector<std::string>& contents) {
  std::vector<StoredResult> unused;
  for (const std::string& content : contents) {
    Statement result(*writer_, std::string(select_result) +
                                   "WHERE content = ? AND NOT EXISTS "
                                   "(SELECT 1 FROM pictures WHERE pictures.content = ?)");
    if (!result.bind(content, content).step()) continue;
    unused.push_back(result_of(result));
    Statement(*writer_, "DELETE FROM results WHERE content = ?").bind(content).run();
  }
  return unused;
}

std::vector<StoredResult> JobStore::least_recently_used(std::uint64_t bytes) const {
  const Lock lock(reader_->mutex);
  Statement statement(*reader_, std::string(select_result) + "ORDER BY used_ms, content");
  std::vector<StoredResult> oldest;
  for (std::uint64_t sum = 0; sum < bytes && statement.step(); sum += oldest.back().bytes)
    oldest.push_back(result_of(statement));
  return oldest;
}

std::uint64_t JobStore::result_bytes() const {
  const Lock lock(reader_->mutex);
  Statement sum(*reader_, "SELECT COALESCE(SUM(bytes), 0) FROM results");
  return sum.step() ? static_cast<std::uint64_t>(sum.integer(0)) : 0;
}

}  // namespace translucube::server
