#pragma once
#include <string>

#include "limcycle/reports/store/sqlite.hpp"
#include "limcycle/reports/store/store.hpp"
#include "limcycle/reports/store/store_schema.hpp"

namespace limcycle {

/// What reading and writing of a store say alike about its file.

StoreError refused_store(const std::string& message);

/// What SQLite said, with the file and what to do about it.
StoreError from_database(const std::string& path, const DatabaseError& error);

/// Links are followed, so that the lock of a store has one name.
std::string true_path(const std::string& path);

/// Is there anything in that file? An empty one is as good as none. Throws StoreError (refused) for a folder or a
/// device.
bool holds_bytes(const std::string& path);

/// Throws StoreError (refused) unless the content is a sweep that this program can read.
void require_sweep(const std::string& path, StoreContent content);

}  // namespace limcycle
