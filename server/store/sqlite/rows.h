#pragma once

// Rows as values: how each is selected, read and found.

#include <spdlog/spdlog.h>

#include <optional>
#include <string>
#include <vector>

#include "api/answer/event.h"
#include "server/store/job.h"
#include "server/store/sqlite/connection.h"
#include "server/store/store_error.h"

namespace translucube::server::rows {

using Lock = std::lock_guard<std::mutex>;

std::string text(api::JobState state);
api::JobState state_of(const std::string& name);

/// `select`: the columns and the table of a row; `read`: the row of such a query. Throws StoreError
/// where it is none of ours.
template <typename Row>
struct Query;
template <>
struct Query<Job> {
  static constexpr const char* select =
      "SELECT id, state, request, material, created_ms, started_ms, finished_ms, passes, samples, "
      "total_samples, relative_error, seconds, eta_seconds, stats, error, cached, sweep_id, "
      "image_index FROM jobs ";
  static Job read(const sql::Statement& row);
};
template <>
struct Query<StoredSweep> {
  static constexpr const char* select =
      "SELECT id, state, request, created_ms, started_ms, finished_ms, points, images "
      "FROM sweeps ";
  static StoredSweep read(const sql::Statement& row);
};
template <>
struct Query<StoredResult> {
  static constexpr const char* select =
      "SELECT content, image, image_bytes, bytes, stats FROM results ";
  static StoredResult read(const sql::Statement& row);
};

/// The first row for which `condition` holds.
template <typename Row, typename... Values>
std::optional<Row> find(sql::Connection& connection, const std::string& condition,
                        const Values&... values) {
  sql::Statement statement(connection, Query<Row>::select + ("WHERE " + condition));
  if (!statement.bind(values...).step()) return std::nullopt;
  return Query<Row>::read(statement);
}

/// The newest rows for which `condition` holds and that pass the filter, newest first.
template <typename Row>
std::vector<Row> page(sql::Connection& connection, const std::string& condition,
                      const JobFilter& filter) {
  std::string query = Query<Row>::select + ("WHERE " + condition + " AND id < ? ");
  if (filter.state) query += "AND state = ? ";
  sql::Statement statement(connection, query + "ORDER BY id DESC LIMIT ?");
  statement.bind(filter.before_id.value_or("~"));  // behind every id
  if (filter.state) statement.bind(text(*filter.state));
  statement.bind(filter.limit);
  std::vector<Row> rows;
  while (statement.step()) try {
      rows.push_back(Query<Row>::read(statement));
    } catch (const StoreError& error) {
      spdlog::error("{} is left out of a list: {}", statement.text(0), error.what());
    }
  return rows;
}

std::vector<Picture> pictures(sql::Connection& connection, const std::string& job_id);
/// The points of a sweep in each state.
api::StateCounts point_counts(sql::Connection& connection, const std::string& sweep_id);

void insert_task(sql::Connection& writer, const std::string& job_id, const Pass& pass,
                 Priority priority);
/// Those that are not done, of a job or of all jobs of a sweep.
void delete_open_tasks(sql::Connection& writer, const std::string& id);

}  // namespace translucube::server::rows
