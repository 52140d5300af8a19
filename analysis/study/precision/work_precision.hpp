#pragma once
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// Quality of an answer.
enum class Quality {
  right,    ///< within `right_within` of the reference
  biased,   ///< an answer of the right kind, but farther off
  wrong,    ///< an answer of another kind: no cycle where there is one, an irregular motion, another attractor
  failed,   ///< no answer; the status gives the reason
  too_slow  ///< given up at the limit of steps or evaluations
};
std::string_view to_string(Quality quality);

/// Relative error up to which an answer counts as right.
inline constexpr double right_within = 0.01;

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// Result of one run of a method with one setting.
struct Attempt {
  Status status = Status::stalled;
  bool answered = false;           ///< there is an answer, right or not
  bool of_another_kind = false;    ///< it is one, but not of the right kind (see Quality::wrong)
  bool gave_up = false;            ///< the limit was reached
  double error = not_known;        ///< relative, against the reference
  double state_error = not_known;  ///< of the final state, see IntegratorCheck; NaN if there is none
  long evaluations = 0;            ///< in the method's own unit
  double measuring = 0.0;          ///< CPU seconds spent on measuring the error, not on the method
  std::string why;                 ///< one sentence, unless it is right
};

/// A method that can be run with several settings, loosest first.
struct WorkMethod {
  std::string name, unit;  ///< unit of the reproducible cost: "steps", "maps", "evaluations"
  std::vector<std::string> settings;
  std::function<Attempt(std::size_t setting)> attempt;
};

/// One point of a work-precision chart. A method that fails is a point too.
struct WorkPoint {
  std::string method, setting;
  double error = not_known, state_error = not_known;
  double seconds = not_known;  ///< CPU, the least of the repeats
  long evaluations = 0;
  std::string unit;
  Quality quality = Quality::failed;
  Status status = Status::stalled;
  std::string why;
  bool charted() const { return quality == Quality::right || quality == Quality::biased; }
};

/// Repeats of runs for timing, and stop function.
struct WorkOptions {
  double repeat_within = 0.02;  ///< CPU seconds: cheap runs are repeated until they took this time in total, or ...
  int repeats = 5;              ///< ... this number of times
  std::function<bool()> stop;
  std::function<void()> done;  ///< called after every setting
};

/// CPU time of the calling thread, s: answers that other threads compute meanwhile do not count.
double cpu_seconds();

/// Every setting of the method, timed. Ends early when `stop` returns true; results until then are kept.
std::vector<WorkPoint> run_method(const WorkMethod& method, const WorkOptions& options);

/// Indices of the points that no other point beats in both error and seconds, cheapest first. Errors below `floor`, the
/// uncertainty of the reference, count as equal to it.
std::vector<std::size_t> pareto_front(const std::vector<WorkPoint>& points, double floor);

/// The cheapest point with at most this error, or nothing: size of `points`.
std::size_t cheapest(const std::vector<WorkPoint>& points, double error);

}  // namespace limcycle
