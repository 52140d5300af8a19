#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/analysis/sweep.hpp"

namespace limcycle {

/// Rows of all points of a sweep: NaN where not known.
struct SweptRows {
  std::vector<bool> known;
  std::vector<double> rows;
  Status status = Status::converged;  ///< or interrupted
};

/// Runs a sweep and keeps its rows. `columns`: their names; `design`: all that defines points and rows, except case,
/// seed and program.
using SweepRunner =
    std::function<SweptRows(const SweepTask& task, const std::vector<std::string>& columns, const std::string& design)>;

/// How a question is worked on, whatever it is.
struct Asking {
  std::uint64_t seed = 0;                                           ///< of everything random
  int threads = 1;                                                  ///< 0: one a core; results do not depend on it
  Isa isa = Isa::scalar;                                            ///< of kernels
  std::function<bool()> stop;                                       ///< true ends the work and keeps the results
  std::function<void(double fraction, std::string_view)> progress;  ///< fraction done (0..1), current activity

  bool stopped() const { return stop && stop(); }
  void report(double fraction, std::string_view what) const {
    if (progress) progress(fraction, what);
  }
  /// Status of work that has none of its own: converged, or interrupted.
  Status ending() const { return stopped() ? Status::interrupted : Status::converged; }
};

/// A runner that keeps the rows in memory. `asking` must outlive it.
SweepRunner sweep_in_memory(const Asking& asking);

}  // namespace limcycle
