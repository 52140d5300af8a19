#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "limcycle/reports/store/sqlite.hpp"
#include "limcycle/reports/store/store.hpp"

namespace limcycle {

/// What stands in the database of a store: `identity` (key, value), `sessions` (one row each time that a sweep was
/// begun or resumed: began, written, rows) and `rows` (point, numbers: doubles with the least byte first, checksum of
/// both).

enum class StoreContent {
  nothing,  ///< no tables: a store that was never begun
  sweep,    ///< a store that this program can read
  newer,    ///< a store of a newer program
  other,    ///< a database of another program
  no_database
};

StoreContent content_of(Database& database);

/// Makes tables and identity in an empty database, in one transaction of the caller.
void make_tables(Database& database, const SweepIdentity& identity);

/// Throws DatabaseError, or StoreError (failed) where a value does not make sense.
SweepIdentity read_identity(Database& database, const std::string& path);

/// What differs between two identities, in words for a message; empty if they are the same.
std::string identity_difference(const SweepIdentity& stored, const SweepIdentity& wanted);

/// The points that are stored, in `known`, and their rows, in `rows`. Throws StoreError (failed) for a row that is not
/// what was written.
void read_rows(Database& database, const std::string& path, StoredSweep& into);

StoreActivity read_activity(Database& database, const std::string& path);

std::vector<unsigned char> bytes_of(std::span<const double> numbers);
std::int64_t checksum(std::size_t point, std::span<const unsigned char> bytes);

}  // namespace limcycle
