#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "limcycle/reports/store/sqlite.hpp"
#include "limcycle/reports/store/store.hpp"

namespace limcycle {

/// Tables in the database of a store: `identity` (key, value), `sessions` (one row each time that a sweep was begun or
/// resumed: began, written, rows) and `rows` (point, numbers: doubles with the least significant byte first, checksum
/// of both).

enum class StoreContent {
  nothing,  ///< no tables: a store that was never begun
  sweep,    ///< a store that this program can read
  newer,    ///< a store of a newer program
  other,    ///< a database of another program
  no_database
};

StoreContent content_of(Database& database);

/// Creates tables and identity in an empty database, within a transaction of the caller.
void make_tables(Database& database, const SweepIdentity& identity);

/// Throws DatabaseError, or StoreError (failed) if a value is invalid.
SweepIdentity read_identity(Database& database, const std::string& path);

/// Differences between two identities, in words for a message; empty if they are the same.
std::string identity_difference(const SweepIdentity& stored, const SweepIdentity& wanted);

/// Reads the stored points into `known` and their rows into `rows`. Throws StoreError (failed) for a row that differs
/// from what was written.
void read_rows(Database& database, const std::string& path, StoredSweep& into);

StoreActivity read_activity(Database& database, const std::string& path);

std::vector<unsigned char> bytes_of(std::span<const double> numbers);
std::int64_t checksum(std::size_t point, std::span<const unsigned char> bytes);

}  // namespace limcycle
