#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/identify/identify.hpp"
#include "limcycle/reports/units.hpp"
#include "limcycle/reports/words.hpp"

namespace limcycle {
namespace {

constexpr double surely_not_white = 1e-3;

std::string unit_of(const IdentifiedNumber& one) { return one.unit == "1" ? "" : one.unit; }

/// The value with the digits that half its interval leaves.
std::string value_text(const IdentifiedNumber& one) {
  if (!one.identifiable) return "not determined";
  const auto &low = one.low ? one.low : one.linear_low, &high = one.high ? one.high : one.linear_high;
  constexpr double least_digits = 0.3;  // a number that is hardly known is not 0
  const double width = high ? 0.5 * (*high - low.value_or(0.0)) : NAN;
  const double half = one.value != 0.0 ? std::min(width, least_digits * std::abs(one.value)) : width;
  return Units::attach(with_absolute_error(one.value, half), unit_of(one));
}

std::string interval_text(const IdentifiedNumber& one) {
  if (!one.low && !one.high) return "-";
  const double half = one.low && one.high ? 0.5 * (*one.high - *one.low) : 0.1 * std::abs(one.value);
  const auto end = [&](const std::optional<double>& at) {
    return at ? with_absolute_error(*at, 0.05 * half) : std::string("?");
  };
  return end(one.low) + " to " + end(one.high);
}

/// "linear: 1.2 to 1.4" where that interval differs from the other by more than a tenth of its half-width.
std::string linear_text(const IdentifiedNumber& one) {
  if (!one.identifiable || !one.low || !one.high || !one.linear_low || !one.linear_high) return "";
  const double half = 0.5 * (*one.high - *one.low), allowed = 0.1 * half;
  if (std::abs(*one.low - *one.linear_low) <= allowed && std::abs(*one.high - *one.linear_high) <= allowed) return "";
  IdentifiedNumber linear = one;
  linear.low = one.linear_low;
  linear.high = one.linear_high;
  return interval_text(linear);
}

std::vector<std::string> not_determined(const IdentifiedLaw& law) {
  std::vector<std::string> names;
  for (const auto& one : law.numbers)
    if (!one.identifiable) names.push_back(one.name);
  return names;
}

std::string answer_text(const IdentifyReport& report) {
  const IdentifiedLaw* law = shown_law(report);
  if (law == nullptr) {
    if (report.status == Status::interrupted) return "No law was fitted: the work was stopped.";
    std::string text = "No law was fitted";
    const char* separator = ": ";
    for (const auto& one : report.laws)
      for (const auto& note : one.notes)
        text += std::exchange(separator, "; ") + std::string(one.law.kind()) + " " + note;
    return text + ".";
  }
  const std::string kind(law->law.kind());
  if (!report.chosen)
    return std::string("No law is recommended: ") +
           (report.status == Status::interrupted ? "the work was stopped before all fits were complete"
                                                 : "no fit converged") +
           ". The numbers below are those of " + kind + " as far as it came.";
  std::string text;
  if (report.laws.size() > 1)
    text = fmt::format(
        "The simplest law that these records support is {}, with {} numbers. Its error on rows that it "
        "was not fitted to is {} of {}.",
        kind, law->fitted, as_percent(law->held_out), largest_measured(report));
  else
    text = fmt::format("{} fits these records; its error on rows that it was not fitted to is {} of {}.", kind,
                       as_percent(law->held_out), largest_measured(report));
  constexpr double no_fit = 0.2;
  if (!(law->held_out <= no_fit))
    text = fmt::format(
        "{} describes these records: {} misses rows that it was not fitted to by {} of {}. A column in another unit, a "
        "plant with other numbers, or other friction?",
        report.laws.size() > 1 ? "None of these laws" : "The law hardly",
        report.laws.size() > 1 ? "the best, " + kind + "," : kind, as_percent(law->held_out), largest_measured(report));
  if (const auto names = not_determined(*law); !names.empty())
    text += fmt::format(" The records do not determine {}.", listed_in_words(names));
  const auto coloured = std::ranges::count_if(
      law->records, [](const RecordFit& one) { return one.whiteness.probability < surely_not_white; });
  if (coloured > 0)
    text += fmt::format(
        " In {} of {} records the residuals are not white: the law misses something there, and the "
        "intervals are too narrow.",
        coloured, law->records.size());
  return text;
}

Table ranking(const IdentifyReport& report) {
  Table table{{{"law", "", Align::left}, {"numbers", ""}, {"BIC", ""}, {"held-out error", ""}, {"", "", Align::left}},
              {}};
  double best = infinite;
  for (const auto& law : report.laws) best = std::isfinite(law.bic) ? std::min(best, law.bic) : best;
  for (std::size_t i = 0; i < report.laws.size(); ++i) {
    const auto& law = report.laws[i];
    const std::string bic = std::isfinite(law.bic) ? fmt::format("+{:.1f}", law.bic - best) : "-";
    table.rows.push_back({std::string(law.law.kind()), std::to_string(law.fitted), bic == "+0.0" ? "least" : bic,
                          as_percent(law.held_out),
                          report.chosen == i                ? "chosen"
                          : law.status == Status::converged ? ""
                                                            : std::string(to_string(law.status))});
  }
  return table;
}

Table number_table(const IdentifiedLaw& law) {
  Table table{{{"number", "", Align::left}, {"value", ""}, {"95 % interval", ""}}, {}};
  const bool linear = std::ranges::any_of(law.numbers, [](const auto& one) { return !linear_text(one).empty(); });
  if (linear) table.columns.push_back({"linearised", ""});
  for (const auto& one : law.numbers) {
    table.rows.push_back({one.name, value_text(one), interval_text(one)});
    if (linear) table.rows.back().push_back(linear_text(one));
  }
  return table;
}

Table record_table(const IdentifyReport& report, const IdentifiedLaw& law) {
  const std::string unit = report.shooting ? "" : "N";  // the same for all records, or one for each
  Table table{{{"record", "", Align::left}, {"rows", ""}, {"error", unit}, {"of largest", ""}, {"white", ""}}, {}};
  for (std::size_t r = 0; r < law.records.size(); ++r) {
    const auto& record = report.records[r];
    const auto& fit = law.records[r];
    const double p = fit.whiteness.probability;
    const std::string white =
        !std::isfinite(p) ? "-"
        : p < surely_not_white
            ? fmt::format("no (p = {:.0e})", p)
            : fmt::format("yes (p = {})", p < 0.005 ? fmt::format("{:.3f}", p) : fmt::format("{:.2f}", p));
    const std::string error = with_digits(fit.error, 3);
    table.rows.push_back({record_label(record), std::to_string(record.compared.size()),
                          unit.empty() ? Units::attach(error, std::string(unit_of(record.quantity))) : error,
                          as_percent(fit.error / record.size), white});
  }
  return table;
}

/// "sigma0^0.70 sigma1^-0.70 (standard deviation: a factor of 12)".
std::string direction_text(const Undetermined& one) {
  const bool single = one.direction.size() == 1;
  std::string product;
  std::vector<std::string> names;
  for (const auto& [name, weight] : one.direction) {
    product += (product.empty() ? "" : " ") + (single ? name : fmt::format("{}^{:.2f}", name, weight));
    names.push_back(name);
  }
  std::string text = single || one.powers ? product : "a combination of " + listed_in_words(names);
  if (!std::isfinite(one.deviation)) return text + (single ? " (no row depends on it)" : " (no row depends on this)");
  if (!one.powers) return text;
  return text +
         fmt::format(" (standard deviation: a factor of {})", with_digits(std::exp(std::min(one.deviation, 300.0)), 2));
}

std::string details(const IdentifyReport& report, const IdentifiedLaw& law) {
  std::vector<std::string> notes;
  for (const auto& one : law.undetermined) notes.push_back("not determined: " + direction_text(one));
  for (Eigen::Index i = 0; i < law.correlations.rows(); ++i)
    for (Eigen::Index k = 0; k < i; ++k)
      if (std::abs(law.correlations(i, k)) > 0.95)
        notes.push_back(fmt::format("{} and {} are correlated by {:.3f}", law.correlated[static_cast<std::size_t>(k)],
                                    law.correlated[static_cast<std::size_t>(i)], law.correlations(i, k)));
  for (const auto& note : law.notes) notes.push_back(note);
  if (report.shooting == Shooting::single)
    notes.emplace_back("free motions: each simulated in one run from its first row, whose state is fitted too");
  if (report.shooting == Shooting::multiple)
    notes.push_back(
        fmt::format("free motions: simulated in {} short runs, as no law follows them in one run from the first row; "
                    "are the numbers "
                    "of the plant right?",
                    law.start_states / 2));
  if (law.march_error > 0.1)
    notes.push_back(fmt::format("the integration error is {} of the noise, more than it should be",
                                with_digits(law.march_error, 2)));
  for (const auto& record : report.records)
    for (const auto& note : record.notes) notes.push_back(record.name + ": " + note);
  return notes_text(notes);
}

/// "1.2 %" of the value, or with the unit where that is 0.
std::string width_text(double half_width, double value, const std::string& unit) {
  if (!std::isfinite(half_width)) return "-";
  return value != 0.0 ? with_digits(100.0 * half_width / std::abs(value), 2) + " %"
                      : Units::attach(with_digits(half_width, 2), unit);
}

Table plan_table(const IdentifiedLaw& law) {
  const IdentifyPlan& plan = *law.plan;
  Table table{{{"number", "", Align::left}, {"now", ""}}, {}};
  for (const PlannedRecord& one : plan.records) table.columns.push_back({"+ " + std::string(to_string(one.kind)), ""});
  for (std::size_t i = 0; i < law.numbers.size(); ++i) {
    std::vector<std::string> cells{law.numbers[i].name,
                                   width_text(plan.half_width[i], plan.values[i], unit_of(law.numbers[i]))};
    double least = infinite;
    for (const PlannedRecord& one : plan.records) least = std::min(least, one.half_width[i]);
    for (const PlannedRecord& one : plan.records)
      cells.push_back(width_text(one.half_width[i], plan.values[i], unit_of(law.numbers[i])) +
                      (std::isfinite(least) && one.half_width[i] <= least ? " *" : "  "));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

/// What to measure next, for the number that is known least.
std::string plan_sentence(const IdentifiedLaw& law) {
  const IdentifyPlan& plan = *law.plan;
  const auto share = [&](const std::vector<double>& widths, std::size_t i) {
    return plan.values[i] == 0.0 ? 0.0 : widths[i] / std::abs(plan.values[i]);
  };
  std::size_t worst = 0;
  for (std::size_t i = 1; i < law.numbers.size(); ++i)
    if (share(plan.half_width, i) > share(plan.half_width, worst)) worst = i;
  const auto best =
      std::ranges::min_element(plan.records, {}, [&](const PlannedRecord& one) { return one.half_width[worst]; });
  const std::string name = law.numbers[worst].name, unit = unit_of(law.numbers[worst]);
  if (!std::isfinite(best->half_width[worst]))
    return fmt::format("No further record of these kinds would determine {}.", name);
  return fmt::format(
      "The number that is known least is {}{}: a further record of the kind {} would narrow it most, to +-{}.", name,
      std::isfinite(plan.half_width[worst]) ? ", to +-" + width_text(plan.half_width[worst], plan.values[worst], unit)
                                            : "",
      to_string(best->kind), width_text(best->half_width[worst], plan.values[worst], unit));
}

}  // namespace

std::string record_label(const PreparedRecord& record) {
  const std::string kind(to_string(record.kind));
  return record.motion ? kind + ", " + std::string(to_string(record.quantity)) : kind;
}

std::string largest_measured(const IdentifyReport& report) {
  std::vector<std::string> list;
  for (const auto& [quantity, name] :
       {std::pair(MeasuredQuantity::force, "force"), std::pair(MeasuredQuantity::position, "displacement"),
        std::pair(MeasuredQuantity::velocity, "speed")})
    if (std::ranges::find(report.records, quantity, &PreparedRecord::quantity) != report.records.end())
      list.emplace_back(name);
  std::string text = "the largest ";
  for (std::size_t i = 0; i < list.size(); ++i) text += (i == 0 ? "" : i + 1 == list.size() ? " or " : ", ") + list[i];
  return text;
}

const IdentifiedLaw* shown_law(const IdentifyReport& report) {
  if (report.chosen) return &report.laws[*report.chosen];
  const auto error = [](const IdentifiedLaw& law) {
    return law.records.empty() || std::isnan(law.held_out) ? infinite : law.held_out;
  };
  const auto best = std::ranges::min_element(report.laws, {}, error);
  if (best != report.laws.end() && error(*best) < infinite) return &*best;
  const auto any = std::ranges::find_if(report.laws, [](const auto& law) { return !law.records.empty(); });
  return any == report.laws.end() ? nullptr : &*any;
}

Document identify_document(const std::string& title, const IdentifyReport& report) {
  Document out(wrapped(title) + "\n" + wrapped(answer_text(report)));
  if (report.laws.size() > 1) out.add("Laws", ranking(report));
  if (const IdentifiedLaw* law = shown_law(report)) {
    out.add(fmt::format("Numbers of {}", law->law.kind()), number_table(*law));
    out.add("Records", record_table(report, *law));
    if (law->plan) {
      out.add("Half-width of the 95 % interval of each number, now and with one more record", plan_table(*law));
      out += wrapped(plan_sentence(*law)) +
             wrapped(fmt::format(
                 "*: narrows it most. The records are those that limcycle synthesize makes for this law, with "
                 "a noise of {} of the largest force{}.",
                 as_percent(law->plan->noise), law->plan->noise_is_assumed ? " (assumed)" : ""));
    }
    out += details(report, *law);
  }
  if (report.status != Status::converged) out += fmt::format("\nStatus: {}\n", to_string(report.status));
  return out;
}

std::string identify_text(const std::string& title, const IdentifyReport& report) {
  return identify_document(title, report).text();
}

}  // namespace limcycle
