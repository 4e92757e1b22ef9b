#include "server/job_store_schema.h"

#include "server/job_store.h"

namespace translucube::server {
namespace {

using sql::Statement;
using sql::Transaction;

constexpr int schema_version = 1;

constexpr const char* schema = R"sql(
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

}  // namespace

void prepare_schema(sql::Connection& writer, const std::filesystem::path& file) {
  writer.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  const std::int64_t version = [&] {
    Statement statement(writer, "PRAGMA user_version");
    return statement.step() ? statement.integer(0) : 0;
  }();
  if (version > schema_version)
    throw StoreError(StoreError::Kind::unavailable,
                     "the job store " + file.string() + " was written by a newer translucube");
  if (version == 0) {
    Transaction transaction(writer);
    writer.execute(schema);
    writer.execute("PRAGMA user_version = " + std::to_string(schema_version));
    transaction.commit();
    return;
  }
  Statement check(writer, "PRAGMA quick_check(1)");
  if (!check.step() || check.text(0) != "ok")
    throw StoreError(StoreError::Kind::corrupt,
                     "the job store " + file.string() + " is corrupt: " + check.text(0));
}

}  // namespace translucube::server
