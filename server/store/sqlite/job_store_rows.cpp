#include "server/store/sqlite/job_store_rows.h"

#include <limits>

namespace translucube::server::rows {

using sql::Statement;

std::string text(api::JobState state) { return std::string(api::name(state)); }

api::JobState state_of(const std::string& name) {
  const std::optional<api::JobState> state = api::job_state(name);
  if (!state) throw StoreError(StoreError::Kind::corrupt, "the job store: an unknown job state");
  return *state;
}

Job job_of(const Statement& row) {
  Job job{.id = row.text(0),
          .state = state_of(row.text(1)),
          .request = row.text(2),
          .material = row.text(3),
          .created_ms = row.integer(4),
          .started_ms = row.optional_integer(5),
          .finished_ms = row.optional_integer(6),
          .progress = {},
          .stats = row.optional_text(13),
          .error = row.optional_text(14),
          .cached = row.integer(15) != 0,
          .sweep_image = {}};
  job.progress.passes = static_cast<std::uint32_t>(row.integer(7));
  job.progress.samples = static_cast<std::uint32_t>(row.integer(8));
  if (!row.is_null(9)) job.progress.total_samples = static_cast<std::uint32_t>(row.integer(9));
  job.progress.relative_error =
      row.optional_real(10).value_or(std::numeric_limits<double>::quiet_NaN());
  job.progress.seconds = row.real(11);
  job.progress.eta_seconds = row.optional_real(12);
  if (!row.is_null(16))
    job.sweep_image = SweepImage{row.text(16), static_cast<std::uint32_t>(row.integer(17))};
  return job;
}

void insert_task(sql::Connection& writer, const std::string& job_id, const Pass& pass,
                 Priority priority) {
  Statement(writer,
            "INSERT INTO tasks(job_id, pass_index, first_sample, sample_count, state, priority) "
            "VALUES (?, ?, ?, ?, 'ready', ?)")
      .bind(job_id, pass.index, pass.first_sample, pass.count, static_cast<int>(priority))
      .run();
}

void delete_open_tasks(sql::Connection& writer, const std::string& job_id) {
  Statement(writer, "DELETE FROM tasks WHERE job_id = ? AND state <> 'done'").bind(job_id).run();
}

api::StateCounts point_counts(sql::Connection& connection, const std::string& id) {
  Statement statement(connection,
                      "SELECT state, SUM(points) FROM jobs WHERE sweep_id = ? GROUP BY state");
  statement.bind(id);
  api::StateCounts counts{};
  while (statement.step())
    counts[static_cast<std::size_t>(state_of(statement.text(0)))] =
        static_cast<std::uint64_t>(statement.integer(1));
  return counts;
}

std::vector<std::string> contents_of(sql::Connection& writer, const std::string& where,
                                     const std::string& id) {
  Statement statement(writer, "SELECT DISTINCT content FROM pictures WHERE " + where);
  statement.bind(id);
  std::vector<std::string> contents;
  while (statement.step()) contents.push_back(statement.text(0));
  return contents;
}

}  // namespace translucube::server::rows
