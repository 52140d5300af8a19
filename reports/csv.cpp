#include "limcycle/reports/csv.hpp"

#include <algorithm>
#include <initializer_list>
#include <stdexcept>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

std::string yes_no(const std::optional<bool>& value) { return value ? (*value ? "true" : "false") : ""; }

std::string index_cell(const std::optional<std::size_t>& value) { return value ? std::to_string(*value) : ""; }

/// Columns of predict: a row fills its own by name, the others stay empty.
constexpr std::string_view predict_columns[] = {
    "kind",      "index",    "method",  "amplitude",     "first_harmonic", "period",
    "frequency", "offset",   "stable",  "multiplier_re", "multiplier_im",  "sticking_fraction",
    "error",     "residual", "verdict", "cycle",         "start",          "outcome",
    "why"};

struct Cell {
  std::string_view column;
  std::string text;
};

void add_row(std::string& out, std::initializer_list<Cell> cells) {
  std::vector<std::string> fields(std::size(predict_columns));
  for (const auto& cell : cells) {
    const auto at = std::find(std::begin(predict_columns), std::end(predict_columns), cell.column);
    fields.at(static_cast<std::size_t>(at - std::begin(predict_columns))) = cell.text;
  }
  out += csv_line(fields);
}

void add_cycle(std::string& out, std::size_t i, const Cycle& cycle) {
  const bool known = !cycle.multipliers.empty();
  add_row(out, {{"kind", "cycle"},
                {"index", std::to_string(i)},
                {"method", cycle.method},
                {"amplitude", shortest(cycle.amplitude)},
                {"first_harmonic", shortest(cycle.first_harmonic)},
                {"period", shortest(cycle.period)},
                {"frequency", shortest(cycle.frequency())},
                {"offset", shortest(cycle.offset)},
                {"stable", yes_no(cycle.stable)},
                {"multiplier_re", known ? shortest(cycle.multipliers.front().real()) : ""},
                {"multiplier_im", known ? shortest(cycle.multipliers.front().imag()) : ""},
                {"sticking_fraction", shortest(cycle.sticking_fraction)},
                {"error", shortest(cycle.error)},
                {"residual", shortest(cycle.residual)}});
}

void add_prediction(std::string& out, std::size_t i, const Prediction& prediction) {
  // A prediction refers to y's first harmonic, which is the column to compare with that of a cycle.
  add_row(out, {{"kind", "prediction"},
                {"index", std::to_string(i)},
                {"method", prediction.method},
                {"amplitude", shortest(prediction.amplitude)},
                {"frequency", shortest(prediction.frequency)},
                {"stable", yes_no(prediction.stable)},
                {"residual", shortest(prediction.residual)},
                {"verdict", std::string(to_string(prediction.verdict))},
                {"cycle", index_cell(prediction.cycle)},
                {"why", prediction.why}});
}

/// Numbers and plain words only, so that no field needs quotes. Values of a result without an answer are left empty.
void add_df_row(std::string& out, const DfPoint& point, const DescribingFunction& result, std::size_t orders) {
  const auto add = [&](double value, bool known) {
    if (known) append_shortest(out, value);
    out += ',';
  };
  const bool answered = result.answered();
  for (const double value : {point.amplitude, point.frequency, point.bias}) add(value, true);
  for (const double value : {result.gain.real(), result.gain.imag(), result.mean}) add(value, answered);
  for (std::size_t k = 0; k < orders; ++k) {
    const bool known = answered && k < result.harmonics.size();
    add(known ? result.harmonics[k].real() : 0.0, known);
    add(known ? result.harmonics[k].imag() : 0.0, known);
  }
  add(result.dissipation, answered);
  add(result.error, answered);
  out.append(result.method).append(1, ',').append(to_string(result.status)).append(1, '\n');
}

}  // namespace

std::string df_csv(const std::vector<DfPoint>& points, const std::vector<DescribingFunction>& results) {
  if (results.size() > points.size()) throw std::invalid_argument("more describing functions than points");
  std::size_t orders = 0;
  for (const auto& result : results) orders = std::max(orders, result.harmonics.size());
  std::vector<std::string> names = {"amplitude", "frequency", "bias", "gain_re", "gain_im", "mean"};
  for (std::size_t k = 1; k <= orders; ++k) {
    names.push_back("harmonic_" + std::to_string(k) + "_sine");
    names.push_back("harmonic_" + std::to_string(k) + "_cosine");
  }
  for (const char* name : {"dissipation", "error", "method", "status"}) names.emplace_back(name);
  std::string out = csv_line(names);
  out.reserve(out.size() + results.size() * (140 + 42 * orders));
  for (std::size_t i = 0; i < results.size(); ++i) add_df_row(out, points[i], results[i], orders);
  return out;
}

std::string predict_csv(const PredictReport& report) {
  std::string out;
  out += csv_line({std::begin(predict_columns), std::end(predict_columns)});
  for (std::size_t i = 0; i < report.cycles.size(); ++i) add_cycle(out, i, report.cycles[i]);
  for (std::size_t i = 0; i < report.predictions.size(); ++i) add_prediction(out, i, report.predictions[i]);
  for (std::size_t i = 0; i < report.missed.size(); ++i)
    add_row(out, {{"kind", "missed"},
                  {"index", std::to_string(i)},
                  {"method", report.missed[i].method},
                  {"cycle", std::to_string(report.missed[i].cycle)}});
  for (std::size_t i = 0; i < report.outcomes.size(); ++i) {
    const auto& outcome = report.outcomes[i];
    add_row(out, {{"kind", "outcome"},
                  {"index", std::to_string(i)},
                  {"cycle", index_cell(outcome.cycle)},
                  {"start", outcome.start},
                  {"outcome", std::string(to_string(outcome.outcome))},
                  {"why", outcome.why}});
  }
  return out;
}

std::string simulate_csv(const Simulation& run) {
  std::string out;
  out += csv_line(run.columns);
  for (const auto& row : run.rows) {
    bool first = true;
    for (const double value : row) {
      if (!first) out += ',';
      first = false;
      out += shortest(value);
    }
    out += '\n';
  }
  return out;
}

}  // namespace limcycle
