#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/remedy/loop_costs.hpp"
#include "limcycle/analysis/study/tune/tune_judge.hpp"
#include "limcycle/analysis/study/tune/tune_space.hpp"

namespace limcycle {

/// Options of tune().
struct TuneOptions {
  PredictOptions predict;  ///< starts, search box, stop, progress; its methods do not matter
  TuneCost minimised = TuneCost::ms;
  TuneCosts limits{};        ///< largest costs that are allowed
  double horizon = 0.0;      ///< s, of ise
  std::size_t samples = 64;  ///< of the design, at least 1
  /// Share by which each number, one at a time, may change without hunting, as far as the bounds reach; one that is 0
  /// stays. 0: none.
  double margin = 0.0;
  std::uint64_t seed = 0;
  int threads = 1;
};

/// A local search.
struct TuneSearch {
  std::size_t from = 0, to = 0;  ///< numbers of points
  std::size_t judged = 0;        ///< points that were asked whether they hunt
  bool ended = false;            ///< by its own criterion, not by its limit of judgements or a stop
};

/// Surroundings of the result along one number: what becomes of a value that is lower and higher by TuneReport::aside.
/// Empty: beyond the bound, or interrupted.
struct TuneSurroundings {
  std::optional<TuneOutcome> below, above;
};

/// Agreement of the local searches that converged.
enum class TuneAgreement {
  none,         ///< there is none
  single,       ///< one search
  same_point,   ///< all end within 5 % of each side of the box and of the cost
  same_cost,    ///< at costs within 1 %, elsewhere
  local_optima  ///< at different costs
};
std::string_view to_string(TuneAgreement agreement);

/// Results of tune().
struct TuneReport {
  std::vector<TuneNumber> numbers;
  TuneCost minimised = TuneCost::ms;
  TuneCosts limits{};
  double horizon = 0.0;
  double margin = 0.0;
  double aside =
      0.01;  ///< share by which the surroundings differ, beyond the margin; for a value of 0 it is 1 % of the range
  double step = 0.0;  ///< height of the step
  Hunts hunts = Hunts::undecided;
  std::string why;                      ///< of that, one clause
  RemedyCosts now = {};                 ///< of the loop as it stands
  std::optional<double> cost_now = {};  ///< the minimised one; empty: not known
  Trace before = {};                    ///< its run from the step
  std::vector<TunePoint> points = {};
  std::optional<std::size_t> best = {};  ///< the feasible point with the least cost; empty: none was found
  RemedyCosts costs = {};                ///< there
  double cost_error = 0.0;               ///< estimated error of the minimised cost there; 0: far below its four digits
  Trace after = {};
  std::vector<TuneSearch> searches = {};
  TuneAgreement agreement = TuneAgreement::none;
  std::vector<TuneSurroundings> surroundings = {};  ///< for each number
  std::vector<std::string> notes = {};
  Status status = Status::converged;

  std::optional<double> best_cost() const {
    return best ? points[*best].costs[static_cast<std::size_t>(minimised)] : std::nullopt;
  }
};

/// Searches the box of the numbers for the least cost of a loop that does not hunt, whose linear loop is stable and
/// whose costs keep to their limits. A design that fills the box is looked at (look_at()), then judged in the order of
/// cost until three points without hunting are known that lie apart from each other; from each of them a DirectSearch
/// runs, with at most 40 judgements. No point beyond a bound is ever tried. The result is judged once more, as
/// predict() would by itself, from the starts of its own search box. All values have four digits. A search of this kind
/// finds local optima; whether several ends agree is stated. The results depend on the seed, not on the number of
/// threads.
///
/// `parts`: of the loop as it stands. Throws std::invalid_argument for no numbers or bounds out of order. Cost: for
/// each point of the design linear_costs() or a run; hunts() for some hundred points.
TuneReport tune(const LoopParts& parts, const std::vector<TuneNumber>& numbers, const LoopWith& loop_with,
                const TuneOptions& options);

}  // namespace limcycle
