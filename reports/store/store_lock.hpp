#pragma once
#include <string>

namespace limcycle {

/// That this process alone writes to a store: a lock on the file PATH-lock, which the kernel takes back however the
/// process ends. Beside the store, not on it: closing a second descriptor of the database would drop SQLite's own
/// locks. The file holds the number of the process; it is removed with the object and may stay after kill -9, which
/// hurts nobody.
class StoreLock {
 public:
  /// Throws StoreError (refused) if another process, or another object of this one, has it, or if the file cannot be
  /// made.
  explicit StoreLock(const std::string& path);
  ~StoreLock();
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;

  /// Who has the lock of that store now: the number of the process, -1 if it is not known, 0: nobody. Takes no lock
  /// itself.
  static long holder(const std::string& path);

 private:
  std::string file_;
  int descriptor_ = -1;
};

}  // namespace limcycle
