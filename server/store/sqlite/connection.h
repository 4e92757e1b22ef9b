#pragma once

// SQLite under RAII. connection.cpp is the only file that includes sqlite3.h; no SQL stands outside
// of this folder.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace translucube::server::sql {

struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const;
};
using PreparedStatement = std::unique_ptr<sqlite3_stmt, FinalizeStatement>;

/// One SQLite connection, used by one thread at a time: hold `mutex`, or a Transaction, from the
/// first statement of a piece of work to the end of the last. Statements stay prepared for the next
/// use of their text: to prepare one takes longer than to look up a row.
class Connection {
 public:
  enum class Access { read_write, read_only };
  /// Throws StoreError.
  Connection(const std::filesystem::path& file, Access access);

  sqlite3* handle() const { return handle_.get(); }
  void execute(const std::string& statements);
  int changes() const;  ///< rows that the last statement touched

  mutable std::mutex mutex;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  friend class Statement;
  PreparedStatement take(std::string_view text);
  void give_back(std::string_view text, PreparedStatement statement);

  std::unique_ptr<sqlite3, Close> handle_;
  std::map<std::string, std::vector<PreparedStatement>, std::less<>> idle_;  ///< by their text
};

/// A prepared statement; parameters are bound in order, columns read in order.
class Statement {
 public:
  Statement(Connection& connection, std::string_view text);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  template <typename... Values>
  Statement& bind(const Values&... values) {
    (bind_one(values), ...);
    return *this;
  }
  bool step();  ///< true while there is a row
  void run();   ///< steps to the end

  std::string text(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;
  bool is_null(int column) const;
  std::optional<std::string> optional_text(int column) const;
  std::optional<std::int64_t> optional_integer(int column) const;
  std::optional<double> optional_real(int column) const;

 private:
  void bind_one(std::string_view value);
  void bind_one(const std::string& value) { bind_one(std::string_view(value)); }
  void bind_one(const char* value) { bind_one(std::string_view(value)); }
  void bind_one(std::int64_t value);
  void bind_one(std::uint32_t value) { bind_one(static_cast<std::int64_t>(value)); }
  void bind_one(int value) { bind_one(static_cast<std::int64_t>(value)); }
  void bind_one(double value);  ///< NaN becomes NULL
  void bind_null();
  template <typename T>
  void bind_one(const std::optional<T>& value) {
    if (value)
      bind_one(*value);
    else
      bind_null();
  }

  Connection& connection_;
  std::string text_;
  PreparedStatement statement_;
  int next_parameter_ = 1;
};

/// How much a commit survives: the end of the process, or a power cut as well, which waits for the
/// disk.
enum class Durability { process, power_cut };

/// A write transaction, rolled back unless committed. It holds the connection's mutex.
class Transaction {
 public:
  explicit Transaction(Connection& connection, Durability durability = Durability::power_cut);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  /// While it lives, commits wait for no disk.
  struct Unsynced {
    Connection& connection;
    explicit Unsynced(Connection& c);
    ~Unsynced();
    Unsynced(const Unsynced&) = delete;
    Unsynced& operator=(const Unsynced&) = delete;
  };
  std::unique_lock<std::mutex> lock_;
  Connection& connection_;
  std::optional<Unsynced> unsynced_;
  bool open_ = true;
};

}  // namespace translucube::server::sql
