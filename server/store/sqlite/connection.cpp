#include "server/store/sqlite/connection.h"

#include <sqlite3.h>

#include <cstdlib>

#include "server/store/store_error.h"

namespace translucube::server::sql {
namespace {

StoreError::Kind error_kind(int code) {
  switch (code & 0xff) {  // the primary code of an extended one
    case SQLITE_FULL:
      return StoreError::Kind::full;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return StoreError::Kind::corrupt;
    default:
      return StoreError::Kind::unavailable;
  }
}

[[noreturn]] void fail(sqlite3* handle, int code, const std::string& doing) {
  const std::string reason = handle ? sqlite3_errmsg(handle) : sqlite3_errstr(code);
  throw StoreError(error_kind(code), "the job store: " + doing + ": " + reason);
}

}  // namespace

void Connection::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

Connection::Connection(const std::filesystem::path& file, Access access) {
  sqlite3* handle = nullptr;
  const int flags = access == Access::read_write ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE
                                                 : SQLITE_OPEN_READONLY;
  const int code = sqlite3_open_v2(file.c_str(), &handle, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(handle);
  if (code != SQLITE_OK) fail(handle, code, "cannot open " + file.string());
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, 5000);
}

void Connection::execute(const std::string& statements) {
  const int code = sqlite3_exec(handle_.get(), statements.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(handle_.get(), code, "cannot do its work");
}

int Connection::changes() const { return sqlite3_changes(handle_.get()); }

void FinalizeStatement::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

PreparedStatement Connection::take(std::string_view text) {
  const auto idle = idle_.find(text);
  if (idle != idle_.end() && !idle->second.empty()) {
    PreparedStatement statement = std::move(idle->second.back());
    idle->second.pop_back();
    return statement;
  }
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(handle_.get(), text.data(), static_cast<int>(text.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) fail(handle_.get(), code, "cannot read its tables");
  return PreparedStatement(statement);
}

void Connection::give_back(std::string_view text, PreparedStatement statement) {
  sqlite3_reset(statement.get());
  sqlite3_clear_bindings(statement.get());
  auto idle = idle_.find(text);
  if (idle == idle_.end()) idle = idle_.try_emplace(std::string(text)).first;
  idle->second.push_back(std::move(statement));
}

Statement::Statement(Connection& connection, std::string_view text)
    : connection_(connection), text_(text), statement_(connection.take(text)) {}

Statement::~Statement() { connection_.give_back(text_, std::move(statement_)); }

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) fail(connection_.handle(), code, "cannot do its work");
  return false;
}

void Statement::run() {
  while (step()) {
  }
}

void Statement::bind_one(std::string_view value) {
  // An empty view may have no address, which would bind NULL.
  sqlite3_bind_text(statement_.get(), next_parameter_++, value.data() ? value.data() : "",
                    static_cast<int>(value.size()), SQLITE_TRANSIENT);
}
void Statement::bind_one(std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), next_parameter_++, value);
}
void Statement::bind_one(double value) {
  sqlite3_bind_double(statement_.get(), next_parameter_++, value);
}
void Statement::bind_null() { sqlite3_bind_null(statement_.get(), next_parameter_++); }

std::string Statement::text(int column) const {
  const auto* bytes = sqlite3_column_text(statement_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return bytes ? std::string(reinterpret_cast<const char*>(bytes), size) : std::string();
}
std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }
bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}
std::optional<std::string> Statement::optional_text(int column) const {
  return is_null(column) ? std::nullopt : std::optional(text(column));
}
std::optional<std::int64_t> Statement::optional_integer(int column) const {
  return is_null(column) ? std::nullopt : std::optional(integer(column));
}
std::optional<double> Statement::optional_real(int column) const {
  return is_null(column) ? std::nullopt : std::optional(real(column));
}

Transaction::Unsynced::Unsynced(Connection& c) : connection(c) {
  connection.execute("PRAGMA synchronous = NORMAL");
}

Transaction::Unsynced::~Unsynced() {
  const int code =
      sqlite3_exec(connection.handle(), "PRAGMA synchronous = FULL", nullptr, nullptr, nullptr);
  // No promise may be made on such a connection; the store survives the end of the process.
  if (code != SQLITE_OK) std::abort();
}

Transaction::Transaction(Connection& connection, Durability durability)
    : lock_(connection.mutex), connection_(connection) {
  if (durability == Durability::process) unsynced_.emplace(connection);
  connection_.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  // A failed statement may already have rolled back; then this fails too, to no harm.
  if (open_) sqlite3_exec(connection_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  connection_.execute("COMMIT");
  open_ = false;
}

}  // namespace translucube::server::sql
