#pragma once
#include <string>

#include "limcycle/reports/store/sqlite.hpp"
#include "limcycle/reports/store/store.hpp"
#include "limcycle/reports/store/store_schema.hpp"

namespace limcycle {

/// Errors and checks of the file of a store, common to reading and writing.

StoreError refused_store(const std::string& message);

/// An error of SQLite, with the file and the remedy.
StoreError from_database(const std::string& path, const DatabaseError& error);

/// Path with links resolved, so that the lock of a store has one name.
std::string true_path(const std::string& path);

/// True if the file has any content; an empty file counts as missing. Throws StoreError (refused) for a folder or a
/// device.
bool holds_bytes(const std::string& path);

/// Throws StoreError (refused) unless the content is a sweep that this program can read.
void require_sweep(const std::string& path, StoreContent content);

}  // namespace limcycle
