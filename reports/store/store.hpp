/// @file
/// The store of a sweep: one file that receives rows as they are finished and from which an interrupted sweep resumes.
///
/// An SQLite database in WAL mode with synchronous = FULL: each transaction is on the disk, not only handed to the
/// system, before the next one begins, so that stored rows survive kill -9 and a loss of power; SQLite's NORMAL would
/// save one fsync a transaction and could lose the last ones. Rows are gathered for a moment first (StoreOptions);
/// these may have to be computed again. While a sweep runs, the files STORE-wal, STORE-shm (SQLite's) and STORE-lock
/// exist next to it; they are removed when it ends. After a kill they remain, and STORE-wal then belongs to the store:
/// it holds the latest rows, until the next session takes them over. Not for a network file system shared by several
/// machines: SQLite's WAL needs one kernel.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace limcycle {

/// Identity of rows that can be compared: a store takes rows of one identity only. All is compared except title and
/// case_file.
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

/// A store that cannot be used or written. The message names the file, the error and the remedy.
class StoreError : public std::runtime_error {
 public:
  enum class Kind {
    refused,  ///< the request does not fit the file: another sweep, not a store, in use, already existing
    failed    ///< the disk: full, unreadable, damaged
  };
  StoreError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

struct StoreOptions {
  double interval = 0.2;          ///< least time between transactions, s, so that fsync does not slow down a fast sweep
  std::size_t waiting = 1 << 16;  ///< most rows that wait for the next one; write() waits for room
};

/// Progress and rate of a sweep. Times are seconds since 1970.
struct StoreActivity {
  std::size_t known = 0;         ///< points stored
  std::size_t sessions = 0;      ///< number of times that the sweep was begun or resumed
  std::size_t session_rows = 0;  ///< stored by the last of them
  double began = 0.0;            ///< begin of the last of them
  double written = 0.0;          ///< last transaction; equal to `began` before the first
  bool running = false;          ///< a process has it open for writing now
  long pid = 0;                  ///< that process, or 0

  /// Points a second of the last session, 0 while unknown.
  double rate() const { return written > began ? static_cast<double>(session_rows) / (written - began) : 0.0; }
};

/// Contents of a store at one moment.
struct StoredSweep {
  SweepIdentity identity;
  std::vector<bool> known;  ///< one flag a point
  std::vector<double>
      rows;  ///< points x columns in the order of the points, bit by bit as written; NaN where not known
  StoreActivity activity;
};

/// Reads a store without changing it, also while a sweep writes to it. Throws StoreError if there is no such file, if
/// it is not a store, of a newer program, or damaged (a checksum detects a changed row).
StoredSweep read_store(const std::string& path);

/// The writer. One process at a time; the file is locked for the life of the object. Safe from several threads.
class SweepStore {
 public:
  /// Creates the store, or with `resume` opens one with the same identity (and creates it if there is none, so that one
  /// command line can be repeated until it is done). Throws StoreError, and leaves the file unchanged, if it exists and
  /// `resume` is false, is of another identity, is no store, is damaged, or another process writes to it.
  SweepStore(const std::string& path, const SweepIdentity& identity, bool resume, const StoreOptions& options = {});
  ~SweepStore();  ///< stores waiting rows without reporting errors: flush() reports them
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  /// One flag a point: stored, or waiting to be.
  std::vector<bool> known() const;

  /// Hands over finished rows, `columns` numbers for each point; they are on the disk one interval later. Throws
  /// std::invalid_argument for a point that does not exist or is known, or a wrong number of numbers (no row is taken
  /// then); StoreError if an earlier row could not be stored (disk full): then the store takes no more rows, but all
  /// stored ones remain, and the sweep can be resumed.
  void write(std::span<const std::size_t> points, std::span<const double> rows);

  /// Returns when all rows handed over are on the disk. Throws StoreError if that fails.
  void flush();

  /// Everything stored, after flush().
  StoredSweep read_all();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limcycle
