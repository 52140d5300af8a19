#pragma once
#include <string>

namespace limcycle {

/// Exclusive right of this process to write to a store: a lock on the file PATH-lock, which the kernel releases however
/// the process ends. A separate file, since closing a second descriptor of the database would release SQLite's own
/// locks. The file contains the process id; it is removed with the object and may remain after kill -9, which does no
/// harm.
class StoreLock {
 public:
  /// Throws StoreError (refused) if another process, or another object of this one, holds it, or if the file cannot be
  /// created.
  explicit StoreLock(const std::string& path);
  ~StoreLock();
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;

  /// Process id of the present holder of the lock of that store, -1 if it is not known, 0 if there is none. Takes no
  /// lock itself.
  static long holder(const std::string& path);

 private:
  std::string file_;
  int descriptor_ = -1;
};

}  // namespace limcycle
