#include "limcycle/reports/store/sqlite.hpp"

#include <sqlite3.h>

namespace limcycle {
namespace {

/// Readers and the writer only meet for moments, when the log is restarted or recovered after a crash.
constexpr int patience_ms = 5000;

DatabaseError database_error(sqlite3* handle, int code) {
  if (handle == nullptr) return {code, sqlite3_errstr(code)};
  return {sqlite3_extended_errcode(handle), sqlite3_errmsg(handle)};
}

}  // namespace

bool DatabaseError::not_a_database() const { return (code_ & 0xff) == SQLITE_NOTADB; }
bool DatabaseError::damaged() const { return (code_ & 0xff) == SQLITE_CORRUPT; }
bool DatabaseError::cannot_open() const { return (code_ & 0xff) == SQLITE_CANTOPEN; }
bool DatabaseError::may_not_write() const { return (code_ & 0xff) == SQLITE_READONLY; }

void Database::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

Database::Database(const std::string& path, Access access) {
  int how = access == Access::read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
  if (access == Access::write) how |= SQLITE_OPEN_CREATE;
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &handle, how | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(handle);  // even a failed one has to be closed
  if (code != SQLITE_OK) throw database_error(handle, code);
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, patience_ms);
}

void Database::run(const std::string& sql) const {
  const int code = sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) throw database_error(handle(), code);
}

std::int64_t Database::number(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.number(0) : 0;
}

std::string Database::text(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.text(0) : std::string();
}

void Statement::Finalize::operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }

Statement::Statement(Database& database, const std::string& sql) : database_(database.handle()) {
  sqlite3_stmt* handle = nullptr;
  check(sqlite3_prepare_v2(database_, sql.c_str(), static_cast<int>(sql.size()), &handle, nullptr));
  handle_.reset(handle);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) throw database_error(database_, code);
}

void Statement::bind(int parameter, std::int64_t value) { check(sqlite3_bind_int64(handle_.get(), parameter, value)); }

void Statement::bind(int parameter, double value) { check(sqlite3_bind_double(handle_.get(), parameter, value)); }

void Statement::bind(int parameter, std::string_view text) {
  // A null pointer would be the SQL value NULL.
  const char* data = text.data() == nullptr ? "" : text.data();
  check(sqlite3_bind_text64(handle_.get(), parameter, data, text.size(), SQLITE_STATIC, SQLITE_UTF8));
}

void Statement::bind(int parameter, std::span<const unsigned char> bytes) {
  check(sqlite3_bind_blob64(handle_.get(), parameter, bytes.data(), bytes.size(), SQLITE_STATIC));
}

bool Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    const DatabaseError error = database_error(database_, code);
    sqlite3_reset(handle_.get());  // returns the same error again
    throw error;
  }
  return false;
}

void Statement::reset() { check(sqlite3_reset(handle_.get())); }

std::int64_t Statement::number(int column) const { return sqlite3_column_int64(handle_.get(), column); }

double Statement::real(int column) const { return sqlite3_column_double(handle_.get(), column); }

std::string Statement::text(int column) const {
  const auto some = bytes(column);
  return {some.begin(), some.end()};
}

std::span<const unsigned char> Statement::bytes(int column) const {
  // In this order: the second call returns the length of the result of the first.
  const void* data = sqlite3_column_blob(handle_.get(), column);
  const int size = sqlite3_column_bytes(handle_.get(), column);
  return {static_cast<const unsigned char*>(data), static_cast<std::size_t>(size)};
}

Transaction::Transaction(Database& database, Kind kind) : database_(database) {
  database_.run(kind == Kind::write ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
  // Some errors (a full disk) have rolled it back already. A failure here is harmless: whoever opens the file next
  // ignores what is not committed.
  if (sqlite3_get_autocommit(database_.handle()) == 0)
    sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() { database_.run("COMMIT"); }

}  // namespace limcycle
