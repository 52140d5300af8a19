#include "limcycle/analysis/study/experiments/by_law.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/sweep.hpp"

namespace limcycle {
namespace {

/// A law that has not finished one experiment by then is stuck in it (for example by switching without end).
constexpr std::chrono::seconds longest_wait{70};

/// Greatest minus least of the finite values.
double width(const std::vector<double>& values) {
  double least = infinite, greatest = -infinite;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  return greatest > least ? greatest - least : 0.0;
}

}  // namespace

void run_by_law(Experiment& experiment, const ExperimentOptions& options,
                const std::function<LawPart(const LawSetting&)>& one) {
  std::vector<LawSetting> laws;
  for (const auto& law : options.laws)
    if (is_friction_kind(law.kind)) laws.push_back(law);
  std::vector<LawPart> parts(laws.size());
  std::vector<char> ran(laws.size(), 0);
  const auto run_one = [&](std::size_t i) {
    try {
      const auto begin = std::chrono::steady_clock::now();
      LawSetting law = laws[i];
      law.stop = [&options, begin] {
        return (options.stop && options.stop()) || std::chrono::steady_clock::now() - begin > longest_wait;
      };
      parts[i] = one(law);
    } catch (const std::invalid_argument& error) {
      parts[i] = {{}, std::string("could not be run: ") + error.what(), Status::not_finite, {}};
    }
    ran[i] = 1;
  };
  run_each(laws.size(), run_one,
           part_of_work(options.threads, options.stop, options.progress, 0.0, 1.0, experiment.name));
  for (std::size_t i = 0; i < laws.size(); ++i) {
    if (ran[i] == 0) {
      experiment.status = Status::interrupted;
      continue;
    }
    LawPart& part = parts[i];
    for (auto& row : part.rows) {
      row.law = laws[i].label;
      experiment.rows.push_back(std::move(row));
    }
    if (!part.finding.empty()) experiment.findings.push_back({laws[i].label, std::move(part.finding), part.status});
    for (std::size_t f = 0; f < part.panels.size() && f < experiment.figures.size(); ++f)
      for (auto& panel : part.panels[f]) {
        panel.title = laws[i].label + (panel.title.empty() ? "" : ", " + panel.title);
        experiment.figures[f].panels.push_back(std::move(panel));
      }
  }
}

void LawPart::add(std::size_t figure, Curve curve, const std::string& title) {
  if (panels.size() <= figure) panels.resize(figure + 1);
  auto& list = panels[figure];
  if (list.empty() || list.back().title != title) list.push_back({title, {}});
  list.back().curves.push_back(std::move(curve));
}

Curve thinned(std::string name, const std::vector<double>& x, const std::vector<double>& y, std::size_t most) {
  Curve curve{std::move(name), {}, {}};
  const double wx = width(x), wy = width(y);
  std::vector<double> length(x.size(), 0.0);
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double dx = wx > 0.0 ? (x[i] - x[i - 1]) / wx : 0.0, dy = wy > 0.0 ? (y[i] - y[i - 1]) / wy : 0.0;
    const double step = std::hypot(dx, dy);
    length[i] = length[i - 1] + (std::isfinite(step) ? step : 0.0);
  }
  const double step = x.empty() ? 0.0 : length.back() / static_cast<double>(std::max<std::size_t>(most, 2));
  double next = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool gap = !std::isfinite(x[i]) || !std::isfinite(y[i]);
    if (length[i] < next && i + 1 < x.size() && !gap) continue;
    // The point before a long stride belongs to it; otherwise a corner would be cut.
    if (i > last + 1 && length[i] - length[i - 1] > step) {
      curve.x.push_back(x[i - 1]);
      curve.y.push_back(y[i - 1]);
    }
    curve.x.push_back(x[i]);
    curve.y.push_back(y[i]);
    last = i;
    next = length[i] + step;
  }
  return curve;
}

double Experiment::value(const std::string& law, const std::string& key, const std::string& setting) const {
  const auto column = std::ranges::find(quantities, key, &Quantity::key) - quantities.begin();
  for (const auto& row : rows)
    if (row.law == law && row.setting == setting && column < std::ssize(row.values))
      return row.values[static_cast<std::size_t>(column)];
  return NAN;
}

bool has_law(const Experiment& experiment, const std::string& law) {
  return std::ranges::any_of(experiment.rows, [&](const Measured& row) { return row.law == law; });
}

std::string quantity(double value, const std::string& unit, int digits) {
  if (!std::isfinite(value)) return "not known";
  return short_number(value, digits) + (unit.empty() ? "" : " " + unit);
}

std::string change(double from, double to) {
  const double percent = 100.0 * (to / from - 1.0);
  if (!std::isfinite(percent)) return "a change that is not known";
  return std::string(percent >= 0.0 ? "+" : "") + short_number(percent, 2) + " %";
}

std::string_view to_string(ClaimOutcome outcome) {
  switch (outcome) {
    case ClaimOutcome::confirmed:
      return "confirmed";
    case ClaimOutcome::not_confirmed:
      return "not confirmed";
    case ClaimOutcome::depends:
      return "depends";
    case ClaimOutcome::not_tested:
      return "not tested";
  }
  return "unknown";
}

}  // namespace limcycle
