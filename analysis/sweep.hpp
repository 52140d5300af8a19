/// @file
/// One engine for everything that evaluates many points: maps, sensitivity, tables, experiments.
///
/// Computing is separate from storing: rows go to a sink as their blocks finish, one call at a time. The sink may be a
/// vector, the store of a file (reports/store/store.hpp) or the writer of a job on several machines, which hands out
/// the same blocks (SweepBlocks) to the next process that asks.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// Computation at each point: a row of `columns` numbers for every index 0 .. points-1.
struct SweepTask {
  std::size_t points = 0;
  std::size_t columns = 0;
  std::size_t block = 1;  ///< points that one call computes, so that kernels can fill their lanes; at least 1

  /// Writes the rows of `points` (increasing indices, at most `block` of them), one after another, and returns how many
  /// it finished, counted from the first: fewer than requested only because it was stopped. Called by several threads
  /// at once.
  ///
  /// The caller's duty: a row depends on its index alone, neither on the other points of its call, nor on what was
  /// computed before, nor on the thread. Random numbers are seeded by the index. Then rows have the same bits for any
  /// number of threads, any block and any interruption. A missing answer may be NaN or an infinity: rows are passed on
  /// bit by bit.
  std::function<std::size_t(std::span<const std::size_t> points, std::span<double> rows)> compute;
};

/// Takes finished rows, `columns` numbers for each of `points` (increasing within a call; the calls come in any order).
/// Called by one thread at a time. An exception ends the sweep.
using SweepSink = std::function<void(std::span<const std::size_t> points, std::span<const double> rows)>;

/// Number of threads, stop function and progress function of a sweep.
struct SweepOptions {
  int threads = 0;             ///< 0: one per core
  std::function<bool()> stop;  ///< called before each block, by one thread at a time

  /// Number of known points, including those known before, and of all points: called once at the beginning and after
  /// each call of the sink, by one thread at a time.
  std::function<void(std::size_t done, std::size_t total)> progress;
};

/// Options of a sweep that is a part of a longer work: its progress is reported as the fractions `from` to `to` of the
/// whole, with `what` as the present activity. `report` may be empty.
SweepOptions part_of_work(int threads, std::function<bool()> stop, std::function<void(double, std::string_view)> report,
                          double from, double to, std::string what);

/// The points that are not known yet, in increasing order, handed out in blocks. Safe from several threads.
class SweepBlocks {
 public:
  /// `known`: one flag a point, or empty if none is known. Throws std::invalid_argument for another size or block = 0.
  SweepBlocks(std::size_t points, std::size_t block, const std::vector<bool>& known);

  /// The next block, the last one perhaps shorter, or `blocks` of them in one span; empty when all were handed out.
  std::span<const std::size_t> next(std::size_t blocks = 1);

  std::size_t missing() const { return missing_.size(); }  ///< points that were not known
  std::size_t blocks() const { return (missing_.size() + block_ - 1) / block_; }

 private:
  std::vector<std::size_t> missing_;
  std::size_t block_;
  std::atomic<std::size_t> next_{0};  ///< index of a block
};

/// Computes every point that is not known, on several threads, and gives its row to the sink as soon as its block is
/// finished. `converged`: every point is known now; `interrupted`: stop() or a call of compute ended it before, and all
/// rows that were finished went to the sink. The first exception of compute, sink, stop or progress is thrown after all
/// threads have ended; rows that went to the sink before stay there. Throws std::invalid_argument for a task without
/// compute or columns, a block of 0, or flags of another number of points.
Status run_sweep(const SweepTask& task, const std::vector<bool>& known, const SweepSink& sink,
                 const SweepOptions& options = {});

/// A sweep that stores its own answers: work(i) for every i = 0 .. count-1. Options and Status as for run_sweep().
Status run_each(std::size_t count, const std::function<void(std::size_t)>& work, const SweepOptions& options = {});

}  // namespace limcycle
