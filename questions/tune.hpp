#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "limcycle/analysis/study/tune/tune.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle {

/// What is wanted of a tuning. Errors name its keys as the caller does: `vary`, `minimise`, `at_most`, `horizon`.
struct TuneWishes {
  struct Bounds {
    std::string name;  ///< path of a number, or its end: "kp"
    double low = 0.0, high = 0.0;
  };
  struct Names {
    std::string vary = "vary", minimise = "minimise", at_most = "at_most", horizon = "horizon";
  };
  std::vector<Bounds> vary;
  TuneCost minimised = TuneCost::ms;
  TuneCosts limits{};
  double horizon = 0.0;  ///< s, of ise; 0: the duration of [simulate]
  std::size_t samples = 64;
  double margin = 0.0;  ///< share of each number
  Names names{};
};

/// The cost of this name. Throws InputError (of `argument`) if there is none.
TuneCost tune_cost_named(const std::string& argument, const std::string& name);

/// The numbers to be chosen. Throws InputError if there are none or more than eight, one is not in the case or named
/// twice, its bounds are out of order, or a bound is not valid with the other numbers as they stand; if a cost is
/// wanted that this loop does not have, or ise without a horizon. Without a loop likewise.
std::vector<TuneNumber> tune_numbers(const Case& from, const TuneWishes& wishes);

/// Flags of the program that ask for this, without those of outputs.
std::string flags_of(const TuneWishes& wishes, std::uint64_t seed);

/// What gives the case the numbers that were found: "PATH=VALUE", as for `--set`. Throws NoAnswer if none were.
std::vector<std::string> overrides_of_tuning(const TuneReport& report);

/// The numbers within their bounds that make a cost least in a loop that does not hunt. Throws as tune_numbers(), and
/// std::invalid_argument if the numbers are valid but too extreme for a method.
TuneReport ask_tune(const Case& from, const TuneWishes& wishes, const Asking& asking);

}  // namespace limcycle
