#pragma once
#include <string>
#include <vector>

#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/store/store.hpp"

namespace limcycle {

/// Summary of a column of a sweep so far. Minimum, mean and maximum are NaN without a finite value.
struct ColumnSummary {
  std::string name;
  std::size_t finite = 0;  ///< of the known points
  double minimum = 0.0, mean = 0.0, maximum = 0.0;
};

/// One for each column, over the finite values of the points that are known.
std::vector<ColumnSummary> column_summaries(const StoredSweep& sweep);

/// Time that the missing points take at the rate of the last session, s; 0 if nothing is missing, NaN while the rate is
/// unknown.
double seconds_left(const StoredSweep& sweep);

/// Text of `limcycle status` about a store. `now`: seconds since 1970.
std::string status_text(const std::string& file, const StoredSweep& sweep, double now);

/// {"store", "sweep": {"command", "design", "version", "commit"}, "points", "known", "running", "process"|null,
/// "sessions", "session_points", "began", "written", "rate"|null, "seconds_left"|null, "columns": [{"column", "finite",
/// "minimum", "mean", "maximum"}]}; began and written in seconds since 1970; case, seed, isa and overrides are those of
/// the store. The provenance is that of the program that reads.
std::string status_json(const Provenance& provenance, const std::string& file, const StoredSweep& sweep);

/// The rows so far: point and the store's columns, in the order of the points; empty fields for NaN and infinities.
std::string status_csv(const StoredSweep& sweep);

}  // namespace limcycle
