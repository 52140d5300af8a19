#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/sections/sections.hpp"

namespace limcycle::case_file {
namespace {

constexpr std::size_t most_parameters = 200;
constexpr int most_samples = 100'000'000;

/// The number of the case that `path` names.
CaseNumber read_path(const Section& section, const std::vector<CaseNumber>& numbers) {
  const Place place = section.at("path", "which parameter, such as \"loop.friction.Fs\"");
  const std::string path = read_string(place);
  const auto found = std::ranges::find(numbers, path, &CaseNumber::path);
  if (found == numbers.end()) {
    std::vector<std::string> paths;
    paths.reserve(numbers.size());
    for (const auto& one : numbers) paths.push_back(one.path);
    throw place.error("is not a parameter of this loop that is one number", suggest(path, paths));
  }
  if (!std::isfinite(found->value)) throw place.error("stands for something absent here: give it a value first");
  return *found;
}

/// Bounds from `from` and `to`, or from a factor on the case's value.
void read_bounds(const Section& section, const CaseNumber& number, SpreadParameter& into) {
  const bool normal = into.distribution == Distribution::normal;
  if (const auto factor = section.find("factor")) {
    if (normal || section.find("from") || section.find("to"))
      throw section.error("factor", "stands instead of from and to, and not with \"normal\"");
    if (number.value == 0.0) throw section.error("factor", "needs a value other than 0 in the case: use from and to");
    const double by = read_number(*factor, {.low = 1.0, .low_open = true});
    into.low = std::min(number.value / by, number.value * by);
    into.high = std::max(number.value / by, number.value * by);
    return;
  }
  into.low = -infinite;
  into.high = infinite;
  if (const auto from = section.find("from")) into.low = read_number(*from, any_number, number.unit);
  if (const auto to = section.find("to")) into.high = read_number(*to, any_number, number.unit);
  if (!normal && !(std::isfinite(into.low) && std::isfinite(into.high)))
    throw section.error(std::isfinite(into.low) ? "to" : "from", "is required: bounds are from and to, or factor");
  if (!(into.low < into.high))
    throw section.error("to", fmt::format("must be greater than from = {}", with_unit(into.low, number.unit)));
}

SpreadParameter read_parameter(const Section& section, const std::vector<CaseNumber>& numbers) {
  section.allow({"path", "distribution", "from", "to", "factor", "mean", "deviation"});
  SpreadParameter one;
  const CaseNumber number = read_path(section, numbers);
  one.path = number.path;
  one.value = number.value;
  constexpr std::string_view names[] = {"uniform", "log-uniform", "normal"};
  constexpr Distribution kinds[] = {Distribution::uniform, Distribution::log_uniform, Distribution::normal};
  if (const auto name = section.find("distribution")) one.distribution = kinds[read_choice(*name, names)];
  const bool normal = one.distribution == Distribution::normal;
  one.mean = number.value;
  if (const auto mean = section.find("mean")) one.mean = read_number(*mean, any_number, number.unit);
  if (normal)
    one.deviation =
        read_number(section.at("deviation", "standard deviation, in the parameter's unit"), positive, number.unit);
  for (const auto* key : {"mean", "deviation"})
    if (!normal && section.find(key)) throw section.error(key, "is allowed only with distribution = \"normal\"");
  read_bounds(section, number, one);
  if (one.distribution == Distribution::log_uniform && !(one.low * one.high > 0.0))
    throw section.error("from", "must have the sign of to, and not be 0, with distribution = \"log-uniform\"");
  if (normal && !(one.low < one.mean && one.mean < one.high))
    throw section.error("mean", "must lie between from and to", {}, with_unit(one.mean, number.unit));
  return one;
}

/// {between = ["loop.friction.Fs", "loop.friction.Fc"], value = 0.8}
SpreadCorrelation read_correlation(const Section& section, const std::vector<SpreadParameter>& parameters) {
  section.allow({"between", "value"});
  const Place between = section.at("between", "two parameters of the list");
  const auto* paths = between.value.as<Value::List>();
  if (paths == nullptr || paths->size() != 2) throw between.error("must be a list of two parameters");
  std::size_t found[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const Place place = between.item(k);
    const std::string path = read_string(place);
    const auto at = std::ranges::find(parameters, path, &SpreadParameter::path);
    if (at == parameters.end()) {
      std::vector<std::string> known;
      known.reserve(parameters.size());
      for (const auto& one : parameters) known.push_back(one.path);
      throw place.error("is not in the list of parameters", suggest(path, known));
    }
    found[k] = static_cast<std::size_t>(at - parameters.begin());
  }
  if (found[0] == found[1]) throw between.error("must be two different parameters");
  const double value = read_number(section.at("value", "the correlation, between -1 and 1"), {-1.0, 1.0, true, true});
  return {std::min(found[0], found[1]), std::max(found[0], found[1]), value};
}

std::vector<SpreadCorrelation> read_correlations(const Place& list, const ParameterSpread& spread) {
  const auto* items = list.value.as<Value::List>();
  if (items == nullptr) throw list.wrong_type("a list of tables {between, value}");
  ParameterSpread so_far = spread;
  for (std::size_t i = 0; i < items->size(); ++i) {
    const Place item = list.item(i);
    const auto one = read_correlation(Section(item.document, item.value, item.path), spread.parameters);
    const auto same = [&](const SpreadCorrelation& other) { return other.one == one.one && other.other == one.other; };
    if (std::ranges::any_of(so_far.correlations, same)) throw item.error("names a pair that stands in the list before");
    so_far.correlations.push_back(one);
  }
  try {
    const JointSpread possible(so_far);
  } catch (const std::invalid_argument& refused) {
    throw list.error(refused.what());
  }
  return so_far.correlations;
}

}  // namespace

std::vector<SpreadParameter> read_spread_list(const Place& list, const std::vector<CaseNumber>& numbers) {
  const auto* items = list.value.as<Value::List>();
  if (items == nullptr) throw list.wrong_type("a list of tables {path, distribution, ...}");
  if (items->empty() || items->size() > most_parameters)
    throw list.error(fmt::format("must have 1 to {} entries", most_parameters));
  std::vector<SpreadParameter> parameters;
  for (std::size_t i = 0; i < items->size(); ++i) {
    const Place item = list.item(i);
    parameters.push_back(read_parameter(Section(item.document, item.value, item.path), numbers));
    const auto& path = parameters.back().path;
    if (std::ranges::count(parameters, path, &SpreadParameter::path) > 1)
      throw item.error(path + " stands in the list twice");
  }
  return parameters;
}

ParameterSpread read_sensitivity(const Section& section, const Case& from) {
  section.allow({"parameters", "correlation", "samples", "seed"});
  ParameterSpread spread;
  spread.parameters = read_spread_list(section.at("parameters", "list of {path, distribution, ...}"), numbers_of(from));
  if (const auto list = section.find("correlation")) spread.correlations = read_correlations(*list, spread);
  if (const auto samples = section.find("samples")) spread.samples = read_integer(*samples, 1, most_samples);
  if (const auto seed = section.find("seed"))
    spread.seed = static_cast<std::uint64_t>(read_integer(*seed, 0, 2147483647));
  return spread;
}

}  // namespace limcycle::case_file
