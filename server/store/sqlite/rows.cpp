#include "server/store/sqlite/rows.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "server/store/store_error.h"

namespace translucube::server::rows {

using sql::Statement;

std::string text(api::JobState state) { return std::string(api::name(state)); }

api::JobState state_of(const std::string& name) {
  const std::optional<api::JobState> state = api::job_state(name);
  if (!state) throw StoreError(StoreError::Kind::corrupt, "the job store: an unknown job state");
  return *state;
}

namespace {

/// What was found made is as far as its stats say.
void progress_of_stats(const std::string& stats, Progress& progress) {
  const auto known = nlohmann::json::parse(stats, nullptr, false);
  if (!known.is_object()) return;
  if (const auto samples = known.find("samples"); samples != known.end() && samples->is_number())
    progress.samples = samples->get<std::uint32_t>();
  if (const auto error = known.find("relative_error"); error != known.end() && error->is_number())
    progress.relative_error = error->get<double>();
}

}  // namespace

Job Query<Job>::read(const Statement& row) {
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
  if (job.cached && job.stats) progress_of_stats(*job.stats, job.progress);
  if (!row.is_null(16))
    job.sweep_image = SweepImage{row.text(16), static_cast<std::uint32_t>(row.integer(17))};
  return job;
}

StoredSweep Query<StoredSweep>::read(const Statement& row) {
  return {row.text(0),
          state_of(row.text(1)),
          row.text(2),
          row.integer(3),
          row.optional_integer(4),
          row.optional_integer(5),
          static_cast<std::uint32_t>(row.integer(6)),
          static_cast<std::uint32_t>(row.integer(7))};
}

StoredResult Query<StoredResult>::read(const Statement& row) {
  StoredResult result{
      row.text(0), row.text(1), {}, static_cast<std::uint64_t>(row.integer(3)), row.text(4)};
  if (const auto bytes = row.optional_integer(2))
    result.image_bytes = static_cast<std::uint64_t>(*bytes);
  return result;
}

std::vector<Picture> pictures(sql::Connection& connection, const std::string& job_id) {
  Statement statement(connection,
                      "SELECT point, content FROM pictures WHERE job_id = ? ORDER BY lane");
  statement.bind(job_id);
  std::vector<Picture> lanes;
  while (statement.step())
    lanes.push_back({static_cast<std::uint32_t>(statement.integer(0)), statement.text(1)});
  return lanes;
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

void insert_task(sql::Connection& writer, const std::string& job_id, const Pass& pass,
                 Priority priority) {
  Statement(writer,
            "INSERT INTO tasks(job_id, pass_index, first_sample, sample_count, state, priority) "
            "VALUES (?, ?, ?, ?, 'ready', ?)")
      .bind(job_id, pass.index, pass.first_sample, pass.count, static_cast<int>(priority))
      .run();
}

void delete_open_tasks(sql::Connection& writer, const std::string& id) {
  Statement(writer,
            "DELETE FROM tasks WHERE state <> 'done' AND job_id IN "
            "(SELECT id FROM jobs WHERE id = ?1 OR sweep_id = ?1)")
      .bind(id)
      .run();
}

}  // namespace translucube::server::rows
