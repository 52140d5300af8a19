/// @file
/// SQLite for the store of a sweep: every result code is checked, and all handles are closed.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

// From sqlite3.h, which no header includes.
struct sqlite3;
struct sqlite3_stmt;

namespace limcycle {

/// An error of SQLite: its extended result code and its message.
class DatabaseError : public std::runtime_error {
 public:
  DatabaseError(int code, const std::string& words) : std::runtime_error(words), code_(code) {}

  bool not_a_database() const;  ///< the file is of another kind
  bool damaged() const;         ///< the file contradicts itself
  bool cannot_open() const;     ///< no such file, no permission
  bool may_not_write() const;   ///< for a reader: a crash left changes that must be rolled back first

 private:
  int code_;
};

/// One connection, for one thread at a time.
class Database {
 public:
  enum class Access { read, recover, write };

  /// `recover` may write, `write` creates the file if there is none. Throws DatabaseError; for a file that is no
  /// database only the first statement does.
  Database(const std::string& path, Access access);

  /// Runs statements without parameters and results.
  void run(const std::string& sql) const;
  /// The first number or text of the only row of `sql`; 0 or empty without a row.
  std::int64_t number(const std::string& sql);
  std::string text(const std::string& sql);

  sqlite3* handle() const { return handle_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::unique_ptr<sqlite3, Close> handle_;
};

/// A prepared statement. Parameters count from 1, columns from 0, as in SQLite.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);

  /// Bound data must live until reset().
  void bind(int parameter, std::int64_t value);
  void bind(int parameter, double value);
  void bind(int parameter, std::string_view text);
  void bind(int parameter, std::span<const unsigned char> bytes);

  bool step();   ///< to the next row; false: there is none
  void reset();  ///< to the beginning, ready to be bound again
  void run() {   ///< a statement without rows
    step();
    reset();
  }

  std::int64_t number(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  std::span<const unsigned char> bytes(int column) const;  ///< valid until the next step()

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const;
  };
  void check(int code) const;

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

/// All or nothing: what is not committed is rolled back.
class Transaction {
 public:
  enum class Kind { read, write };
  Transaction(Database& database, Kind kind);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
};

}  // namespace limcycle
