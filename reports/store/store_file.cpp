#include "limcycle/reports/store/store_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "limcycle/reports/store/store_lock.hpp"

namespace limcycle {

StoreError refused_store(const std::string& message) { return {StoreError::Kind::refused, message}; }

StoreError from_database(const std::string& path, const DatabaseError& error) {
  if (error.not_a_database()) return refused_store(path + " is not a store of limcycle");
  if (error.damaged())
    return {StoreError::Kind::failed,
            fmt::format("{} is damaged ({}): compute it again into another file", path, error.what())};
  if (error.cannot_open()) return refused_store(fmt::format("{} cannot be opened: {}", path, error.what()));
  return {StoreError::Kind::failed, fmt::format("{}: {}", path, error.what())};
}

std::string true_path(const std::string& path) {
  std::error_code failed;
  const auto whole = std::filesystem::weakly_canonical(path, failed);
  return failed || path.empty() ? path : whole.string();
}

bool holds_bytes(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::exists(path, failed)) return false;
  if (!std::filesystem::is_regular_file(path, failed)) throw refused_store(path + " is not a file");
  return std::filesystem::file_size(path, failed) > 0;
}

void require_sweep(const std::string& path, StoreContent content) {
  switch (content) {
    case StoreContent::sweep:
      return;
    case StoreContent::nothing:
      throw refused_store(path + " holds no sweep yet");
    case StoreContent::newer:
      throw refused_store(path + " was made by a newer limcycle: use that version");
    case StoreContent::other:
    case StoreContent::no_database:
      throw refused_store(path + " is not a store of limcycle: name another file");
  }
}

namespace {

StoredSweep read_store(const std::string& path, Database::Access access) {
  StoredSweep stored;
  Database database(path, access);
  // A snapshot, consistent during concurrent writes.
  Transaction transaction(database, Transaction::Kind::read);
  require_sweep(path, content_of(database));
  stored.identity = read_identity(database, path);
  read_rows(database, path, stored);
  stored.activity = read_activity(database, path);
  const long pid = StoreLock::holder(path);
  stored.activity.running = pid != 0;
  stored.activity.pid = std::max(pid, 0L);
  return stored;
}

}  // namespace

StoredSweep read_store(const std::string& path) {
  const std::string file = true_path(path);
  if (!holds_bytes(file)) throw refused_store(file + " does not exist or is empty");
  try {
    try {
      return read_store(file, Database::Access::read);
    } catch (const DatabaseError& error) {
      // A process was killed while it opened or closed the store: the next one to open it rolls its changes back.
      if (!error.may_not_write()) throw;
      return read_store(file, Database::Access::recover);
    }
  } catch (const DatabaseError& error) {
    throw from_database(file, error);
  }
}

}  // namespace limcycle
