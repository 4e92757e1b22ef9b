#include "server/store/sqlite/schema.h"

#include "server/store/store_error.h"

namespace translucube::server {
namespace {

using sql::Statement;
using sql::Transaction;

constexpr int schema_version = 3;

/// What version 1 was: a store of that age is brought up to date from here.
constexpr const char* schema_1 = R"sql(
CREATE TABLE jobs(
  id TEXT PRIMARY KEY NOT NULL,
  state TEXT NOT NULL,
  request TEXT NOT NULL,
  material TEXT NOT NULL,
  idempotency_key TEXT UNIQUE,
  created_ms INTEGER NOT NULL,
  started_ms INTEGER,
  finished_ms INTEGER,
  passes INTEGER NOT NULL DEFAULT 0,
  samples INTEGER NOT NULL DEFAULT 0,
  total_samples INTEGER,
  relative_error REAL,
  seconds REAL NOT NULL DEFAULT 0,
  eta_seconds REAL,
  stats TEXT,
  error TEXT,
  image TEXT);
CREATE INDEX jobs_by_state ON jobs(state, id);
CREATE TABLE tasks(
  job_id TEXT NOT NULL REFERENCES jobs(id) ON DELETE CASCADE,
  pass_index INTEGER NOT NULL,
  first_sample INTEGER NOT NULL,
  sample_count INTEGER NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('ready', 'leased', 'done')),
  owner TEXT,
  lease_until_ms INTEGER NOT NULL DEFAULT 0,
  not_before_ms INTEGER NOT NULL DEFAULT 0,
  fencing_token INTEGER NOT NULL DEFAULT 0,
  attempts INTEGER NOT NULL DEFAULT 0,
  seconds REAL NOT NULL DEFAULT 0,
  PRIMARY KEY (job_id, pass_index)) WITHOUT ROWID;
CREATE INDEX tasks_open ON tasks(job_id, pass_index) WHERE state <> 'done';
CREATE TABLE probe(id INTEGER PRIMARY KEY, written_ms INTEGER NOT NULL);
)sql";

/// Sweeps, results by their content, events, priorities. The results of version 1 lie in the folder
/// of their job, whose id thus is the name of their content; one that is not finished is put
/// elsewhere, since that folder goes with the job's end.
constexpr const char* from_1_to_2 = R"sql(
CREATE TABLE sweeps(
  id TEXT PRIMARY KEY NOT NULL,
  state TEXT NOT NULL,
  request TEXT NOT NULL,
  idempotency_key TEXT UNIQUE,
  created_ms INTEGER NOT NULL,
  started_ms INTEGER,
  finished_ms INTEGER,
  points INTEGER NOT NULL,
  images INTEGER NOT NULL);
ALTER TABLE jobs ADD COLUMN sweep_id TEXT REFERENCES sweeps(id) ON DELETE CASCADE;
ALTER TABLE jobs ADD COLUMN image_index INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN points INTEGER NOT NULL DEFAULT 1;
ALTER TABLE jobs ADD COLUMN cached INTEGER NOT NULL DEFAULT 0;
CREATE INDEX jobs_of_sweep ON jobs(sweep_id, image_index) WHERE sweep_id IS NOT NULL;
CREATE INDEX renders_by_state ON jobs(state, id) WHERE sweep_id IS NULL;
ALTER TABLE tasks ADD COLUMN priority INTEGER NOT NULL DEFAULT 0;
DROP INDEX tasks_open;
CREATE INDEX tasks_open ON tasks(priority, job_id, pass_index) WHERE state <> 'done';
CREATE TABLE pictures(
  job_id TEXT NOT NULL REFERENCES jobs(id) ON DELETE CASCADE,
  lane INTEGER NOT NULL,
  point INTEGER NOT NULL,
  content TEXT NOT NULL,
  PRIMARY KEY (job_id, lane)) WITHOUT ROWID;
CREATE INDEX pictures_by_content ON pictures(content);
CREATE TABLE results(
  content TEXT PRIMARY KEY NOT NULL,
  image TEXT NOT NULL,
  image_bytes INTEGER,
  stats TEXT NOT NULL,
  bytes INTEGER NOT NULL,
  used_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE INDEX results_by_use ON results(used_ms, content);
CREATE TABLE events(
  subject TEXT NOT NULL,
  number INTEGER NOT NULL,
  type TEXT NOT NULL,
  data TEXT NOT NULL,
  PRIMARY KEY (subject, number)) WITHOUT ROWID;
CREATE TRIGGER events_of_job AFTER DELETE ON jobs
  BEGIN DELETE FROM events WHERE subject = OLD.id; END;
CREATE TRIGGER events_of_sweep AFTER DELETE ON sweeps
  BEGIN DELETE FROM events WHERE subject = OLD.id; END;
INSERT INTO pictures SELECT id, 0, 0,
  CASE WHEN state IN ('queued', 'running') THEN lower(hex(randomblob(32))) ELSE id END FROM jobs;
INSERT INTO results SELECT id, image, NULL, COALESCE(stats, '{}'), 0, finished_ms
  FROM jobs WHERE state = 'succeeded' AND image IS NOT NULL;
ALTER TABLE jobs DROP COLUMN image;
)sql";

/// Deaths of the process while a job was worked on (recovery.cpp); files of what was removed.
constexpr const char* from_2_to_3 = R"sql(
ALTER TABLE jobs ADD COLUMN deaths INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN suspect INTEGER NOT NULL DEFAULT 0;
ALTER TABLE tasks ADD COLUMN renewed INTEGER NOT NULL DEFAULT 0;
CREATE INDEX jobs_suspect ON jobs(id) WHERE suspect = 1;
CREATE TABLE process(
  id INTEGER PRIMARY KEY CHECK (id = 1),
  ends_as_told INTEGER NOT NULL);
INSERT INTO process VALUES (1, 0);
ALTER TABLE jobs ADD COLUMN picture_bytes INTEGER NOT NULL DEFAULT 0;
CREATE INDEX jobs_by_need ON jobs(picture_bytes) WHERE state IN ('queued', 'running');
CREATE INDEX renders_by_end ON jobs(finished_ms)
  WHERE sweep_id IS NULL AND finished_ms IS NOT NULL;
CREATE INDEX sweeps_by_end ON sweeps(finished_ms) WHERE finished_ms IS NOT NULL;
CREATE TABLE leftovers(
  folder TEXT NOT NULL,
  image TEXT NOT NULL,
  PRIMARY KEY (folder, image)) WITHOUT ROWID;
)sql";

/// SQLite reads the bytes that its last page lacks as zeros.
bool ends_in_a_page(sql::Connection& writer, const std::filesystem::path& file) {
  Statement page_size(writer, "PRAGMA page_size");
  std::error_code in_memory;
  const std::uintmax_t bytes = std::filesystem::file_size(file, in_memory);
  return in_memory ||
         (page_size.step() && bytes % static_cast<std::uintmax_t>(page_size.integer(0)) == 0);
}

std::int64_t version_of(sql::Connection& writer) {
  Statement statement(writer, "PRAGMA user_version");
  return statement.step() ? statement.integer(0) : 0;
}

void check(sql::Connection& writer, const std::filesystem::path& file, std::int64_t version) {
  const auto corrupt = [&](const std::string& why) {
    return StoreError(StoreError::Kind::corrupt,
                      "the job store " + file.string() + " is corrupt: " + why);
  };
  if (version > schema_version)
    throw StoreError(StoreError::Kind::unavailable,
                     "the job store " + file.string() + " was written by a newer translucube");
  if (version <= 0) return;
  if (!ends_in_a_page(writer, file)) throw corrupt("it was cut short");
  Statement check(writer, "PRAGMA quick_check(1)");
  if (!check.step() || check.text(0) != "ok") throw corrupt(check.text(0));
}

void upgrade(sql::Connection& writer, std::int64_t version) {
  Transaction transaction(writer);
  if (version < 1) writer.execute(schema_1);
  if (version < 2) writer.execute(from_1_to_2);
  writer.execute(from_2_to_3);
  writer.execute("PRAGMA user_version = " + std::to_string(schema_version));
  transaction.commit();
}

}  // namespace

void prepare_schema(sql::Connection& writer, const std::filesystem::path& file) {
  writer.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  const std::int64_t version = version_of(writer);
  check(writer, file, version);
  if (version == schema_version) return;
  upgrade(writer, version);
  // The file itself says from now on what it is, and not its journal alone.
  writer.execute("PRAGMA wal_checkpoint(TRUNCATE)");
}

}  // namespace translucube::server
