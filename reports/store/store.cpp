#include "limcycle/reports/store/store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "limcycle/reports/store/store_file.hpp"
#include "limcycle/reports/store/store_lock.hpp"
#include "limcycle/reports/store/store_schema.hpp"

namespace limcycle {
namespace {

using StoreClock = std::chrono::steady_clock;

double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void make_durable(Database& database, const std::string& path) {
  if (database.text("PRAGMA journal_mode = WAL") != "wal")
    throw StoreError(StoreError::Kind::failed, path + ": this file system has no shared memory, which a store needs");
  database.run("PRAGMA synchronous = FULL");
}

void remove_store(const std::string& path) {
  std::error_code ignored;
  for (const char* end : {"", "-wal", "-shm", "-journal"}) std::filesystem::remove(path + end, ignored);
}

const SweepIdentity& checked_identity(const SweepIdentity& identity) {
  if (identity.columns.empty()) throw std::invalid_argument("store: a row has at least one number");
  return identity;
}

const StoreOptions& checked_options(const StoreOptions& options) {
  if (!(options.interval >= 0.0 && options.interval <= 3600.0))
    throw std::invalid_argument("store: the interval must lie in 0..3600 s");
  if (options.waiting == 0) throw std::invalid_argument("store: at least one row has to wait");
  return options;
}

/// Rows waiting to be written.
struct WaitingRows {
  std::vector<std::size_t> points;
  std::vector<double> rows;
};

}  // namespace

struct SweepStore::Impl {
  Impl(const std::string& named, const SweepIdentity& wanted, bool resume, const StoreOptions& wished)
      : path(true_path(named)), identity(checked_identity(wanted)), options(checked_options(wished)), lock(path) {
    if (holds_bytes(path) && !resume)
      throw refused_store(path + " exists already: continue it with --resume, or choose another file");
    std::error_code ignored;
    const bool there = std::filesystem::exists(path, ignored);
    try {
      open();
    } catch (const DatabaseError& error) {
      if (!there) forget();
      throw from_database(path, error);
    } catch (...) {
      if (!there) forget();
      throw;
    }
    writer = std::jthread([this](const std::stop_token& stop) { write_out(stop); });
  }

  ~Impl() {
    writer.request_stop();
    if (writer.joinable()) writer.join();
    rest();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void open() {
    database.emplace(path, Database::Access::write);
    const StoreContent content = content_of(*database);
    if (content == StoreContent::nothing) {
      make_durable(*database, path);
      Transaction transaction(*database, Transaction::Kind::write);
      make_tables(*database, identity);
      begin_session();
      transaction.commit();
      known.assign(identity.points, false);
    } else {
      require_sweep(path, content);
      go_on();
    }
  }

  void go_on() {
    if (const auto differs = identity_difference(read_identity(*database, path), identity); !differs.empty())
      throw refused_store(fmt::format(
          "{} holds another sweep: {}. Repeat the command that began it, or choose another file", path, differs));
    if (const auto found = database->text("PRAGMA quick_check(1)"); found != "ok")
      throw StoreError(StoreError::Kind::failed,
                       fmt::format("{} is damaged ({}): compute it again into another file", path, found));
    StoredSweep stored{.identity = identity, .known = {}, .rows = {}, .activity = {}};
    read_rows(*database, path, stored);
    known = std::move(stored.known);
    make_durable(*database, path);
    Transaction transaction(*database, Transaction::Kind::write);
    begin_session();
    transaction.commit();
  }

  void begin_session() {
    Statement insert(*database, "INSERT INTO sessions(began, written, rows) VALUES(?1, ?1, 0)");
    insert.bind(1, seconds_since_1970());
    insert.run();
    session = database->number("SELECT max(id) FROM sessions");
  }

  /// Leaves WAL mode: without its log the store is one file, readable on read-only media. A reader or a full disk may
  /// prevent it; the store is valid with its log too.
  void rest() {
    try {
      database->run("PRAGMA busy_timeout = 100; PRAGMA journal_mode = DELETE");
    } catch (const DatabaseError&) {
      return;
    }
  }

  /// Removes a store that could not be created.
  void forget() {
    database.reset();
    remove_store(path);
  }

  std::size_t stored_points() const {
    return static_cast<std::size_t>(std::count(known.begin(), known.end(), true)) - waiting.points.size();
  }

  void write_out(const std::stop_token& stop);
  void store(const WaitingRows& batch);
  void fail(const std::string& words, std::size_t lost);

  const std::string path;
  const SweepIdentity identity;
  const StoreOptions options;
  const StoreLock lock;
  std::optional<Database> database;  ///< used by the constructor, then by the writer
  std::int64_t session = 0;

  mutable std::mutex guard;  ///< protects the members below
  std::condition_variable_any changed;
  std::vector<bool> known;
  WaitingRows waiting;
  std::size_t flushing = 0;  ///< calls of flush() that wait
  bool storing = false;      ///< a transaction is in progress
  std::optional<StoreError> failure;

  std::jthread writer;  ///< ends before the other members
};

/// The only thread that writes to the disk: other threads wait for it only if too many rows are waiting already.
void SweepStore::Impl::write_out(const std::stop_token& stop) {
  const auto interval =
      std::chrono::duration_cast<StoreClock::duration>(std::chrono::duration<double>(options.interval));
  auto next = StoreClock::now();
  std::unique_lock held(guard);
  while (!failure) {
    changed.wait(held, stop, [this] { return !waiting.points.empty(); });
    if (waiting.points.empty()) return;  // asked to end, and nothing is left
    changed.wait_until(held, stop, next, [this] { return flushing > 0 || waiting.points.size() >= options.waiting; });
    const WaitingRows batch = std::exchange(waiting, {});
    storing = true;
    held.unlock();
    std::string words;
    try {
      store(batch);
    } catch (const std::exception& error) {
      words = error.what();
    }
    held.lock();
    storing = false;
    if (!words.empty()) fail(words, batch.points.size());
    next = StoreClock::now() + interval;
    changed.notify_all();
  }
}

void SweepStore::Impl::store(const WaitingRows& batch) {
  const std::size_t columns = identity.columns.size();
  Transaction transaction(*database, Transaction::Kind::write);
  Statement insert(*database, "INSERT INTO rows VALUES(?, ?, ?)");
  for (std::size_t i = 0; i < batch.points.size(); ++i) {
    const auto bytes = bytes_of({batch.rows.data() + i * columns, columns});
    insert.bind(1, static_cast<std::int64_t>(batch.points[i]));
    insert.bind(2, std::span<const unsigned char>(bytes));
    insert.bind(3, checksum(batch.points[i], bytes));
    insert.run();
  }
  Statement update(*database, "UPDATE sessions SET written = ?, rows = rows + ? WHERE id = ?");
  update.bind(1, seconds_since_1970());
  update.bind(2, static_cast<std::int64_t>(batch.points.size()));
  update.bind(3, session);
  update.run();
  transaction.commit();
}

/// Rows of a failed transaction are lost, as are those waiting: they are computed again after --resume.
void SweepStore::Impl::fail(const std::string& words, std::size_t lost) {
  failure.emplace(
      StoreError::Kind::failed,
      fmt::format(
          "{}: {}; {} of {} points are stored and safe: fix this (free some space), then continue with --resume", path,
          words, stored_points() - lost, identity.points));
}

SweepStore::SweepStore(const std::string& path, const SweepIdentity& identity, bool resume, const StoreOptions& options)
    : impl_(std::make_unique<Impl>(path, identity, resume, options)) {}

SweepStore::~SweepStore() = default;

std::vector<bool> SweepStore::known() const {
  const std::lock_guard held(impl_->guard);
  return impl_->known;
}

void SweepStore::write(std::span<const std::size_t> points, std::span<const double> rows) {
  Impl& store = *impl_;
  if (rows.size() != points.size() * store.identity.columns.size())
    throw std::invalid_argument(
        fmt::format("store: {} numbers for {} rows of {}", rows.size(), points.size(), store.identity.columns.size()));
  std::unique_lock held(store.guard);
  store.changed.wait(held, [&] { return store.failure || store.waiting.points.size() < store.options.waiting; });
  if (store.failure) throw StoreError(*store.failure);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool fits = points[i] < store.known.size() && !store.known[points[i]];
    if (fits) {
      store.known[points[i]] = true;
      continue;
    }
    for (std::size_t k = 0; k < i; ++k) store.known[points[k]] = false;
    throw std::invalid_argument(fmt::format("store: point {} does not exist or is known already", points[i]));
  }
  store.waiting.points.insert(store.waiting.points.end(), points.begin(), points.end());
  store.waiting.rows.insert(store.waiting.rows.end(), rows.begin(), rows.end());
  store.changed.notify_all();
}

void SweepStore::flush() {
  Impl& store = *impl_;
  std::unique_lock held(store.guard);
  ++store.flushing;
  store.changed.notify_all();
  store.changed.wait(held, [&] { return store.failure || (store.waiting.points.empty() && !store.storing); });
  --store.flushing;
  if (store.failure) throw StoreError(*store.failure);
}

StoredSweep SweepStore::read_all() {
  flush();
  return read_store(impl_->path);
}

}  // namespace limcycle
