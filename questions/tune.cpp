#include "limcycle/questions/tune.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/remedy/linear_costs.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/questions/asking/answer_of.hpp"
#include "limcycle/questions/asking/argument_error.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

constexpr std::size_t most_numbers = 8;

bool wants(const TuneWishes& wishes, TuneCost cost) {
  return wishes.minimised == cost || wishes.limits[static_cast<std::size_t>(cost)];
}

double horizon_of(const Case& from, const TuneWishes& wishes) {
  return wishes.horizon > 0.0 || !from.simulate ? wishes.horizon : from.simulate->duration;
}

/// Rejects a cost that this loop does not have.
void check_costs(const Case& from, const TuneWishes& wishes) {
  const LoopParts& parts = need_loop(from);
  const auto key = [&](TuneCost cost) {
    return wishes.minimised == cost ? wishes.names.minimise : wishes.names.at_most;
  };
  if (wants(wishes, TuneCost::ms)) {
    const std::string why = linear_costs(parts, 0.0).why_not;
    if (!why.empty()) throw argument_error(key(TuneCost::ms), "ms", "this loop has no peak sensitivity: " + why);
  }
  for (const TuneCost cost : {TuneCost::settling, TuneCost::ise}) {
    if (!wants(wishes, cost)) continue;
    const std::string name(to_string(cost));
    if (!uses_error(parts))
      throw argument_error(key(cost), name, "this loop has no set-point to settle at: no controller");
    if (parts.reference_rate != 0.0)
      throw argument_error(key(cost), name, "needs a set-point that stands still, not a ramp");
  }
  if (wants(wishes, TuneCost::ise) && !(horizon_of(from, wishes) > 0.0))
    throw argument_error(key(TuneCost::ise), "ise",
                         "is an integral over a time that the case does not state: add " + wishes.names.horizon +
                             ", or [simulate] with duration");
}

/// What the reader of cases says of a value; may be empty.
std::string broken_rule(const Case& from, const std::string& override) {
  auto overrides = from.overrides;
  overrides.push_back(override);
  try {
    read_again(from, overrides);
  } catch (const InputError& error) {
    return error.fault().rule;
  }
  return {};
}

TuneNumber tune_number(const Case& from, const TuneWishes::Bounds& bounds, const std::string& argument) {
  const CaseNumber number = number_named(from, argument, bounds.name);
  const auto text = [&](double value) { return number.path + "=" + shortest(value); };
  if (!std::isfinite(bounds.low) || !std::isfinite(bounds.high) || !(bounds.low < bounds.high))
    throw argument_error(argument, bounds.name, "the lower bound must be below the upper one, and both finite");
  const LoopVariation variation(from, argument, number.path);
  for (const double bound : {bounds.low, bounds.high})
    if (!variation.parts({&bound, 1}))
      throw argument_error(argument, text(bound),
                           "this bound is not a valid value with the other numbers as they stand",
                           broken_rule(from, override_of(number.path, bound)));
  return {number.path, number.unit, number.value, bounds.low, bounds.high};
}

}  // namespace

TuneCost tune_cost_named(const std::string& argument, const std::string& name) {
  return static_cast<TuneCost>(
      position_named(argument, name, {std::begin(tune_cost_names), std::end(tune_cost_names)}, "is not a cost"));
}

std::vector<TuneNumber> tune_numbers(const Case& from, const TuneWishes& wishes) {
  need_loop(from);
  const std::string& argument = wishes.names.vary;
  if (wishes.vary.empty() || wishes.vary.size() > most_numbers)
    throw argument_error(argument, {}, "needs 1 to 8 numbers with their bounds, such as kp=1:100");
  std::vector<TuneNumber> numbers;
  for (const auto& bounds : wishes.vary) {
    numbers.push_back(tune_number(from, bounds, argument));
    if (std::ranges::count(numbers, numbers.back().path, &TuneNumber::path) > 1)
      throw argument_error(argument, bounds.name, "is named twice");
  }
  check_costs(from, wishes);
  return numbers;
}

std::string flags_of(const TuneWishes& wishes, std::uint64_t seed) {
  std::string text;
  for (const auto& one : wishes.vary)
    text += (text.empty() ? "--vary " : ",") + one.name + "=" + shortest(one.low) + ":" + shortest(one.high);
  text += " --minimise " + std::string(to_string(wishes.minimised));
  for (std::size_t i = 0; i < wishes.limits.size(); ++i)
    if (wishes.limits[i]) text += " --at-most " + std::string(tune_cost_names[i]) + "=" + shortest(*wishes.limits[i]);
  if (wishes.horizon > 0.0) text += " --horizon " + shortest(wishes.horizon);
  if (wishes.margin > 0.0) text += " --margin " + shortest(with_four_digits(100.0 * wishes.margin));
  text += " --samples " + std::to_string(wishes.samples);
  return seed == 0 ? text : text + " --seed " + std::to_string(seed);
}

std::vector<std::string> overrides_of_tuning(const TuneReport& report) {
  if (!report.best) throw NoAnswer("no point without hunting was found: there is nothing to apply");
  std::vector<std::string> overrides;
  for (std::size_t i = 0; i < report.numbers.size(); ++i)
    overrides.push_back(override_of(report.numbers[i].path, report.points[*report.best].values[i]));
  return overrides;
}

TuneReport ask_tune(const Case& from, const TuneWishes& wishes, const Asking& asking) {
  const auto numbers = tune_numbers(from, wishes);
  std::vector<std::string> paths;
  paths.reserve(numbers.size());
  for (const TuneNumber& one : numbers) paths.push_back(one.path);
  TuneOptions options;
  options.predict = from.predict;
  options.predict.stop = asking.stop;
  options.predict.progress = asking.progress;
  options.minimised = wishes.minimised;
  options.limits = wishes.limits;
  if (wants(wishes, TuneCost::ise)) options.horizon = horizon_of(from, wishes);
  options.samples = wishes.samples;
  options.margin = wishes.margin;
  options.seed = asking.seed;
  options.threads = asking.threads;
  const LoopVariation variation(from, wishes.names.vary, paths);
  return tune(
      *from.loop, numbers, [&](std::span<const double> values) { return variation.parts(values); }, options);
}

}  // namespace limcycle
