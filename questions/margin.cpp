#include "limcycle/questions/margin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/questions/asking/argument_error.hpp"
#include "limcycle/questions/threshold.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

MarginParameter margin_parameter(const Case& from, const CaseNumber& number) {
  return {number.path, number.unit, number.value, number.path.starts_with("loop.friction."),
          LoopVariation(from, "parameter", number.path)};
}

/// The straight line from the own numbers of a case, at 1, to others, at 2.
struct Line {
  std::vector<CaseNumber> own;
  std::vector<double> to;
  std::string target{};  ///< "kd = 10, ki = 2", with the names as they were given

  std::vector<double> at(double place) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < own.size(); ++i)
      values.push_back(own[i].value + (place - 1.0) * (to[i] - own[i].value));
    return values;
  }
  std::string name() const { return "toward " + target; }
};

Line line_of(const Case& from, const std::string& argument, const Toward& toward) {
  Line line;
  for (const auto& [name, value] : toward) {
    const CaseNumber number = number_named(from, argument, name);
    if (!std::isfinite(number.value))
      throw argument_error(argument, name, "is absent from the case: write it there first, so that it has a value");
    if (std::ranges::find(line.own, number.path, &CaseNumber::path) != line.own.end())
      throw argument_error(argument, name, "is there twice");
    line.own.push_back(number);
    line.to.push_back(value);
    line.target += (line.target.empty() ? "" : ", ") + name + " = " + shortest(value);
  }
  return line;
}

MarginParameter toward_parameter(const Case& from, const std::string& argument, const Toward& toward) {
  const Line line = line_of(from, argument, toward);
  std::vector<std::string> paths;
  bool friction = !line.own.empty(), changes = false;
  for (std::size_t i = 0; i < line.own.size(); ++i) {
    paths.push_back(line.own[i].path);
    friction = friction && line.own[i].path.starts_with("loop.friction.");
    changes = changes || line.to[i] != line.own[i].value;
  }
  if (!changes) throw argument_error(argument, line.target, "changes nothing: these are the numbers of the case");
  const LoopVariation variation(from, argument, paths);
  if (!variation.parts(line.to))
    throw argument_error(argument, line.target, "these are not valid values with the other numbers as they stand");
  return {line.name(), "1", 1.0, friction, [variation, line](double place) { return variation.loop(line.at(place)); }};
}

/// Where the numbers of such a parameter stand at the change nearest to 1; empty if none was found.
std::string numbers_toward(const Case& from, const std::string& argument, const Toward& toward,
                           const MarginReport& report) {
  const Line line = line_of(from, argument, toward);
  const std::string name = line.name();
  const auto one = std::ranges::find(report.parameters, name, [](const auto& p) { return p.parameter.path; });
  const MarginSide* side = one == report.parameters.end() ? nullptr : one->nearest();
  if (side == nullptr) return {};
  std::string text;
  const auto values = line.at(side->value);
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("{}{} = {:.6g}", i == 0 ? "" : ", ", line.own[i].path, values[i]);
  return fmt::format("{}: 1 stands for the numbers of the case, 2 for those given; at {:.6g} {}", name, side->value,
                     text);
}

/// All numbers that a factor changes; the others into a note.
std::vector<MarginParameter> all_parameters(const Case& from, std::vector<std::string>& notes) {
  std::vector<MarginParameter> chosen;
  std::string zero;
  for (const auto& number : numbers_of(from)) {
    if (number.follows || !std::isfinite(number.value)) continue;
    if (number.value != 0.0)
      chosen.push_back(margin_parameter(from, number));
    else
      zero += (zero.empty() ? "" : ", ") + number.path;
  }
  if (!zero.empty()) notes.push_back("skipped, because the value is 0: " + zero);
  return chosen;
}

}  // namespace

std::vector<MarginParameter> margin_parameters(const Case& from, const MarginWishes& wishes,
                                               std::vector<std::string>& notes) {
  if (wishes.paths.empty() && wishes.toward.empty()) return all_parameters(from, notes);
  std::vector<MarginParameter> chosen;
  for (const auto& number : threshold_numbers(from, wishes.names.paths, wishes.paths))
    chosen.push_back(margin_parameter(from, number));
  for (const Toward& one : wishes.toward) chosen.push_back(toward_parameter(from, wishes.names.toward, one));
  return chosen;
}

MarginReport ask_margin(const Case& from, const MarginWishes& wishes, const Asking& asking) {
  std::vector<std::string> notes;
  const auto parameters = margin_parameters(from, wishes, notes);
  MarginOptions options;
  options.factor = wishes.factor;
  options.threads = asking.threads;
  options.predict = from.predict;
  options.predict.stop = asking.stop;
  options.predict.progress = asking.progress;
  MarginReport report = margin(build_loop(need_loop(from)), parameters, options);
  for (const Toward& one : wishes.toward)
    if (auto text = numbers_toward(from, wishes.names.toward, one, report); !text.empty())
      notes.push_back(std::move(text));
  report.notes.insert(report.notes.end(), notes.begin(), notes.end());
  return report;
}

}  // namespace limcycle
