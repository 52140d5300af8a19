#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "limcycle/reports/continuation/margin.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

std::string unit_of(const MarginParameter& one) { return one.unit == "1" ? "" : one.unit; }

/// Value with its accurate digits, at most six.
std::string side_place(const MarginSide& side) {
  if (std::isnan(side.error)) return with_digits(side.value, 3);
  return with_error(side.value, std::max(side.error, 0.6e-5));
}

/// "-27 %"; "x 6.0" from a doubling on.
std::string size_of(double value, double own) {
  const double ratio = value / own;
  if (ratio >= 2.0) return fmt::format("x {}", with_digits(ratio, 3));
  return fmt::format("{}{} %", ratio >= 1.0 ? "+" : "-", with_digits(std::abs(100.0 * (ratio - 1.0)), 3));
}

/// "0.27", "1.0094": with three digits of the change where that is small.
std::string factor_on(double value, double own) {
  const double ratio = value / own, change = std::abs(ratio - 1.0);
  const int digits = change < 0.5 ? 3 - static_cast<int>(std::floor(std::log10(std::max(change, 1e-5)))) : 3;
  return with_digits(ratio, std::clamp(digits, 3, 6));
}

std::string cell(const MarginSide& side, double own) {
  switch (side.what) {
    case MarginSide::What::none:
      return side.value == 0.0 ? "none" : "none to " + with_digits(side.value, 3);
    case MarginSide::What::unknown:
      return "?";
    default:
      return fmt::format("{} (x {})", side_place(side), factor_on(side.value, own));
  }
}

/// What is there: ", at a fold"; empty if that is not known.
std::string kind_of(const MarginSide& side) {
  if (side.diverges && side.diverges_at != 0.0)
    return fmt::format(", but at {} it diverges", with_digits(side.diverges_at, 4));
  if (side.diverges) return ", but it diverges beyond";
  if (side.event == BranchEvent::Type::fold) return ", at a fold";
  return side.event == BranchEvent::Type::stability ? ", where the cycle changes its stability" : "";
}

/// A change of one parameter.
struct Change {
  const MarginParameter* of;
  const MarginSide* to;

  double size() const { return std::abs(to->value / of->value - 1.0); }
};

/// "lower loop.friction.Fs from 1.5 N to 1.04 N (-31 %, at a fold)".
std::string in_words(const Change& change) {
  const auto& [of, to] = change;
  const bool raise = std::abs(to->value) > std::abs(of->value);
  return fmt::format("{} {} from {} to {} ({}{})", raise ? "raise" : "lower", of->path, with_digits(of->value, 4),
                     Units::attach(side_place(*to), unit_of(*of)), size_of(to->value, of->value), kind_of(*to));
}

/// The least change that ends or begins hunting; of a loop that hunts, one after which it diverges only where there is
/// no other.
std::optional<Change> smallest_change(const MarginReport& report, bool friction) {
  std::optional<Change> best;
  const auto better = [&](const Change& one) {
    if (!best) return true;
    if (report.hunts && one.to->diverges != best->to->diverges) return best->to->diverges;
    return one.size() < best->size();
  };
  for (const auto& one : report.parameters) {
    if (one.parameter.friction != friction) continue;
    for (const MarginSide* side : {&one.up, &one.down})
      if (const Change change{&one.parameter, side}; side->found() && better(change)) best = change;
  }
  return best;
}

std::string of_balance(const MarginReport& report) {
  if (!report.balance) return "";
  const auto& [distance, amplitude, frequency] = *report.balance;
  const std::string where =
      fmt::format("amplitude {} and {} rad/s", with_digits(amplitude, 3), with_digits(frequency, 3));
  if (distance < 1e-4) return " The describing function's -1/N meets the Nyquist curve at " + where + ".";
  return fmt::format(
      " The describing function finds no cycle: -1/N comes within {} of the Nyquist curve (nearest at {}).",
      as_percent(distance), where);
}

bool has_unknown_side(const MarginReport& report) {
  return std::ranges::any_of(report.parameters, [](const ParameterMargin& one) {
    return one.up.what == MarginSide::What::unknown || one.down.what == MarginSide::What::unknown;
  });
}

}  // namespace

std::vector<std::string> margin_reasons(const MarginReport& report, bool friction) {
  std::vector<std::string> sentences;
  for (const auto& one : report.parameters) {
    if (one.parameter.friction != friction) continue;
    for (const auto* side : {&one.up, &one.down})
      if (side->what != MarginSide::What::none || side->why.find("none") == 0)
        sentences.push_back(fmt::format("{} {}: {}.", one.parameter.path, side == &one.up ? "up" : "down", side->why));
  }
  return sentences;
}

Table margin_table(const MarginReport& report, bool friction) {
  const std::string verb = report.hunts ? "ends" : "begins";
  Table table{
      {{"parameter", "", Align::left}, {"value", ""}, {verb + " above", ""}, {verb + " below", ""}, {"distance", ""}},
      {}};
  for (const auto& one : report.parameters) {
    if (one.parameter.friction != friction) continue;
    const double own = one.parameter.value;
    table.rows.push_back({short_path(one.parameter.path),  // 80 columns
                          Units::attach(with_digits(own, 4), unit_of(one.parameter)), cell(one.up, own),
                          cell(one.down, own), std::isfinite(one.distance()) ? as_percent(one.distance()) : "-"});
  }
  return table;
}

std::string margin_answer(const MarginReport& report, const Units& units) {
  std::string out = report.status == Status::interrupted ? "Interrupted; partial result: " : "";
  if (!report.refused.empty()) {
    out += "Not answered: " + report.refused + " over a parameter. `limcycle map` answers over a plane of parameters.";
    return out + of_balance(report);
  }
  if (report.hunts) {
    const auto stable = std::ranges::find(report.cycles, std::optional<bool>(true), &Cycle::stable);
    out += stable == report.cycles.end()
               ? std::string("This loop hunts without a period.")
               : fmt::format("This loop has a stable limit cycle (period {} s, amplitude {}).",
                             with_digits(stable->period, 4), Units::attach(with_digits(stable->amplitude, 4), units.y));
  } else {
    out += "No stable limit cycle was found.";
  }
  const auto design = smallest_change(report, false), law = smallest_change(report, true);
  const std::string verb = report.hunts ? "ends it" : "starts one";
  const std::string where = report.status == Status::interrupted ? "the numbers below" : "plant or controller";
  if (design)
    out += fmt::format(" The smallest change of {} that {}: {}.", where, verb, in_words(*design));
  else if (std::ranges::any_of(report.parameters, [](const auto& one) { return !one.parameter.friction; }))
    out += has_unknown_side(report)
               ? fmt::format(
                     " No single change of {} within a factor of {:g} was found that {}, but some directions are "
                     "undetermined.",
                     where, report.factor, verb)
               : fmt::format(" No single change of {} within a factor of {:g} {}.", where, report.factor, verb);
  if (law) out += fmt::format(" The smallest change of the friction: {}.", in_words(*law));
  return out + of_balance(report);
}

Document margin_document(const std::string& title, const MarginReport& report, const Units& units) {
  Document out(wrapped(title) + "\n" + wrapped(margin_answer(report, units)));
  for (const bool friction : {false, true}) {
    const Table table = margin_table(report, friction);
    if (table.rows.empty()) continue;
    out.add(fmt::format("{}: where hunting {}", friction ? "Friction" : "Plant and controller",
                        report.hunts ? "ends" : "begins"),
            table);
    for (const auto& sentence : margin_reasons(report, friction)) out += wrapped(sentence, 80, 2);
  }
  out += notes_text(report.notes);
  if (report.status != Status::converged) out += fmt::format("\nStatus: {}\n", to_string(report.status));
  return out;
}

std::string margin_text(const std::string& title, const MarginReport& report, const Units& units) {
  return margin_document(title, report, units).text();
}

}  // namespace limcycle
