/// @file
/// The store of a sweep: one file that takes rows as they are finished and from which an interrupted sweep goes on.
///
/// An SQLite database in WAL mode with synchronous = FULL: each transaction is on the disk, not only handed to the
/// system, before the next one begins, so that what was once stored survives kill -9 and a loss of power; SQLite's
/// NORMAL would save one fsync a transaction and could lose the last ones. Rows are gathered for a moment first
/// (StoreOptions), which is what may have to be computed again. While a sweep runs there are STORE-wal, STORE-shm
/// (SQLite's) and STORE-lock beside the file; they go when it ends. After a kill they stay, and STORE-wal then belongs
/// to the store: it holds what was stored last, until the next session takes it up. Not for a network file system
/// shared by several machines: SQLite's WAL needs one kernel.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace limcycle {

/// What makes rows comparable: a store takes rows of one identity only. All is compared but title and case_file.
struct SweepIdentity {
  std::string command;                 ///< "map", "sensitivity", ...
  std::string title, case_file;        ///< for the reader
  std::string case_sha256;             ///< of the bytes of the case file
  std::vector<std::string> overrides;  ///< --set PATH=VALUE, in order
  std::string design;                  ///< axes or plan of the points and settings of the method, as text
  std::uint64_t seed = 0;
  std::vector<std::string> columns;  ///< names of the numbers of a row
  std::size_t points = 0;            ///< of the whole sweep
  std::string version, commit, isa;  ///< of the program: another one may round differently
};

/// A store that cannot be used or written. The message names the file, what is wrong and what to do.
class StoreError : public std::runtime_error {
 public:
  enum class Kind {
    refused,  ///< the request does not fit the file: another sweep, not a store, in use, there already
    failed    ///< the disk: full, unreadable, damaged
  };
  StoreError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

struct StoreOptions {
  double interval = 0.2;          ///< s between transactions at least: fsync shall not be what a fast sweep waits for
  std::size_t waiting = 1 << 16;  ///< rows that wait for the next one at most; write() waits for room
};

/// How far a sweep got, and how fast. Times are seconds since 1970.
struct StoreActivity {
  std::size_t known = 0;         ///< points stored
  std::size_t sessions = 0;      ///< times that a sweep was begun or resumed
  std::size_t session_rows = 0;  ///< stored by the last of them
  double began = 0.0;            ///< the last of them
  double written = 0.0;          ///< last transaction; equal to `began` before the first
  bool running = false;          ///< a process has it open for writing now
  long pid = 0;                  ///< that process, or 0

  /// Points a second of the last session, 0 while unknown.
  double rate() const { return written > began ? static_cast<double>(session_rows) / (written - began) : 0.0; }
};

/// Everything in a store at one moment.
struct StoredSweep {
  SweepIdentity identity;
  std::vector<bool> known;  ///< one flag a point
  std::vector<double>
      rows;  ///< points x columns in the order of the points, bit by bit as written; NaN where not known
  StoreActivity activity;
};

/// Reads a store without changing it, also while a sweep writes to it. Throws StoreError if there is no such file, if
/// it is not a store, of a newer program, or damaged (a row that is not what was written is found by its checksum).
StoredSweep read_store(const std::string& path);

/// The writer. One process at a time; the file is locked until the object goes. Safe from several threads.
class SweepStore {
 public:
  /// Makes the store, or with `resume` opens one that was begun with the same identity (and makes it where there is
  /// none, so that one command line can be repeated until it is done). Throws StoreError, and leaves the file as it
  /// was, if it exists and `resume` is false, is of another identity, is no store, is damaged, or another process
  /// writes to it.
  SweepStore(const std::string& path, const SweepIdentity& identity, bool resume, const StoreOptions& options = {});
  ~SweepStore();  ///< stores what waits, in silence: call flush() to hear of errors
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  /// One flag a point: stored, or waiting to be.
  std::vector<bool> known() const;

  /// Hands over finished rows, `columns` numbers for each point; they are on the disk one interval later. Throws
  /// std::invalid_argument for a point that does not exist or is known, or another number of numbers (nothing is taken
  /// then); StoreError if an earlier row could not be stored (disk full): then the store takes no more, but all that
  /// was stored stays, and the sweep can be resumed.
  void write(std::span<const std::size_t> points, std::span<const double> rows);

  /// Returns when everything handed over is on the disk. Throws StoreError if it cannot be.
  void flush();

  /// All that is stored, after flush().
  StoredSweep read_all();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limcycle
