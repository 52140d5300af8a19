/// @file
/// CPU time of a run, and one line of results for bench/table.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace bench {

/// CPU time of this process, s: other programs on the machine affect it less than wall time.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Least CPU time of `run`, which is repeated for a tenth of a second, at most 41 times. The least, since other work of
/// the machine only adds to the times.
template <class Run>
double least_cpu_seconds(Run&& run) {
  double least = 0.0, total = 0.0;
  for (int count = 0; count < 41 && (count == 0 || total < 0.1); ++count) {
    const double begin = cpu_seconds();
    run();
    const double seconds = cpu_seconds() - begin;
    least = count == 0 ? seconds : std::min(least, seconds);
    total += seconds;
  }
  return least;
}

/// One measured run. An empty status means that it ended; an inaccurate answer shows in the error.
struct Row {
  std::string part;       ///< stepping, df, cycles, ensembles
  std::string problem;    ///< one of the part's problems
  std::string contender;  ///< the program or method
  std::string setting;    ///< tolerance, mesh, ...
  double error = -1.0;    ///< true error; negative: no answer
  double seconds = 0.0;   ///< CPU
  long evaluations = 0;   ///< of the right side; 0: not counted
  std::string status{};   ///< reason for a missing answer
};

inline void print(const Row& row) {
  std::printf("%s,%s,%s,%s,%.4e,%.6e,%ld,%s\n", row.part.c_str(), row.problem.c_str(), row.contender.c_str(),
              row.setting.c_str(), row.error, row.seconds, row.evaluations, row.status.c_str());
  std::fflush(stdout);
}

inline std::string short_power(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

}  // namespace bench
