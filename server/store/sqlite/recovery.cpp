// What a process that died had in hand. What ended it may be one of the jobs that it worked on, and
// would end every process after it. A process that was told to end, or killed from outside, looks
// the same but for what it wrote before: so a job is held to blame only where nothing else can be.

#include <spdlog/spdlog.h>

#include "server/store/refusals.h"
#include "server/store/sqlite/rows.h"
#include "server/store/sqlite/sqlite_job_store.h"

namespace translucube::server {

using api::JobState;
using rows::Lock;
using sql::Statement;
using sql::Transaction;

namespace {

// Deaths at which the job was alone, since its last complete pass. A kill from outside that comes
// soon after the start of a task says little of it, but where it comes again and again: so ends
// what takes all memory at once.
constexpr int most_deaths = 2, most_early_kills = 8;

std::vector<std::string> first_column(sql::Connection& writer, const char* query) {
  std::vector<std::string> texts;
  Statement statement(writer, query);
  while (statement.step()) texts.push_back(statement.text(0));
  return texts;
}

bool ended_as_told(sql::Connection& writer) {
  Statement statement(writer, "SELECT ends_as_told FROM process");
  return statement.step() && statement.integer(0) != 0;
}

}  // namespace

/// Inside a transaction: frees the tasks that the last process held, and judges their jobs.
void SqliteJobStore::take_over() {
  std::vector<std::string> suspects = first_column(
      writer_, "SELECT DISTINCT job_id FROM tasks WHERE state <> 'done' AND state = 'leased'");
  const bool was_long =
      !first_column(writer_, "SELECT job_id FROM tasks WHERE state = 'leased' AND renewed = 1")
           .empty();
  if (ended_as_told(writer_)) suspects.clear();
  Statement(writer_, "UPDATE process SET ends_as_told = 0").run();
  Statement(writer_,
            "UPDATE tasks SET state = 'ready', owner = NULL, not_before_ms = 0 "
            "WHERE state <> 'done'")
      .run();
  for (const std::string& id : suspects)
    Statement(writer_, "UPDATE jobs SET suspect = 1 WHERE id = ?").bind(id).run();
  if (suspects.size() == 1) judge(suspects.front(), options_.last_crashed || was_long);
  for (const std::string& id : first_column(writer_, "SELECT id FROM jobs WHERE state = 'running'"))
    move(id, JobState::queued);
}

/// Charges the job that was alone at the death of the last process, and fails it if that was one
/// too many.
void SqliteJobStore::judge(const std::string& id, bool for_sure) {
  Statement charge(writer_, "UPDATE jobs SET deaths = deaths + 1 WHERE id = ? RETURNING deaths");
  if (!charge.bind(id).step()) return;
  const std::int64_t deaths = charge.integer(0);
  charge.run();
  if (deaths < (for_sure ? most_deaths : most_early_kills)) return;
  spdlog::error("render {} failed: {}", id, ended_the_process().detail);
  rows::delete_open_tasks(writer_, id);
  Statement(writer_, "UPDATE jobs SET error = ? WHERE id = ?")
      .bind(api::to_json(ended_the_process()), id)
      .run();
  move(id, JobState::failed);
}

/// Whether a suspect is worked on, or is the next to be while anything else may be under way. One
/// that waits for its time lets the others go on.
SqliteJobStore::Trial SqliteJobStore::trial() {
  const std::int64_t now = options_.lease_clock();
  Statement suspects(writer_,
                     "SELECT MAX(tasks.state = 'leased' AND lease_until_ms >= ?1), "
                     "MAX(tasks.state = 'leased' OR not_before_ms <= ?1) "
                     "FROM jobs JOIN tasks ON job_id = id "
                     "WHERE suspect = 1 AND tasks.state <> 'done'");
  if (!suspects.bind(now).step() || suspects.is_null(0)) return Trial::none;
  if (suspects.integer(0) != 0) return Trial::under_way;
  if (suspects.integer(1) == 0) return Trial::none;
  Statement others(writer_,
                   "SELECT 1 FROM tasks WHERE state <> 'done' AND state = 'leased' AND "
                   "lease_until_ms >= ? LIMIT 1");
  return others.bind(now).step() ? Trial::under_way : Trial::due;
}

void SqliteJobStore::announce_end() {
  const Lock lock(writer_.mutex);
  Statement(writer_, "UPDATE process SET ends_as_told = 1").run();
}

}  // namespace translucube::server
