/// @file
/// Cost of a row for the writer of a map: for rows handed over one at a time, one for each message, which wakes the
/// store's own thread each time, and for all rows at once.
///   store_rows FILE      prints CPU seconds a row: one at a time, of the thread that hands it over and of the store's;
///   at once, of both
#include <time.h>

#include <cstdio>
#include <string>
#include <vector>

#include "limcycle/bench/measure.hpp"
#include "limcycle/reports/store/store.hpp"

namespace {

constexpr std::size_t rows = 50'000;

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct RowCost {
  double handing = 0.0, storing = 0.0;
};

/// Writes rows at intervals of `between` seconds.
RowCost cost_of_rows(const std::string& file, double between) {
  limcycle::SweepIdentity identity;
  identity.command = "map";
  identity.columns = {"a", "b", "c", "d", "e", "f", "g", "h"};  // as many as a map with one method
  identity.points = rows;
  std::remove(file.c_str());
  limcycle::SweepStore store(file, identity, false);
  std::vector<double> row(identity.columns.size(), 0.1);
  const double mine = thread_seconds(), all = bench::cpu_seconds();
  RowCost cost;
  for (std::size_t point = 0; point < rows; ++point) {
    row[0] = static_cast<double>(point);
    const double begin = thread_seconds();
    store.write(std::vector{point}, row);
    cost.handing += (thread_seconds() - begin) / rows;
    while (thread_seconds() - begin < between) {
    }
  }
  store.flush();
  cost.storing = (bench::cpu_seconds() - all - (thread_seconds() - mine)) / rows;
  return cost;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "store_rows FILE\n");
    return 2;
  }
  const RowCost single = cost_of_rows(argv[1], 40e-6), bulk = cost_of_rows(argv[1], 0.0);
  std::remove(argv[1]);
  std::printf("%.9f %.9f %.9f\n", single.handing, single.storing, bulk.handing + bulk.storing);
  return 0;
}
