#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

constexpr int run_digits = 6;

/// Unit of a column; empty: none, or one that only the case defines (states).
std::string unit_of(const std::string& column, const Units& units) {
  const auto rate_of = [](const std::string& unit) { return unit.empty() ? unit : unit + "/s"; };
  if (column == "t") return "s";
  if (column == "y") return units.y;
  if (column == "dy_dt") return rate_of(units.y);
  if (column == "loop.friction.input") return units.input;
  if (column == "loop.friction.rate") return rate_of(units.input);
  return column == "loop.friction.output" ? units.force : "";
}

Table ranges(const Simulation& run, const Units& units) {
  Table table{{{"column", "", Align::left}, {"first", ""}, {"least", ""}, {"greatest", ""}, {"last", ""}}, {}};
  for (std::size_t i = 0; i < run.columns.size(); ++i) {
    double least = INFINITY, greatest = -INFINITY;
    for (const auto& row : run.rows) {
      least = std::min(least, row.at(i));
      greatest = std::max(greatest, row.at(i));
    }
    const std::string unit = unit_of(run.columns[i], units);
    table.rows.push_back({run.columns[i] + (unit.empty() ? "" : " [" + unit + "]"),
                          with_digits(run.rows.front().at(i), run_digits), with_digits(least, run_digits),
                          with_digits(greatest, run_digits), with_digits(run.rows.back().at(i), run_digits)});
  }
  return table;
}

std::string outcome_in_words(const Simulation& run, const Units& units) {
  if (run.outcome == Outcome::cycle)
    return fmt::format("It settles on a cycle of period {} s and amplitude {}.", with_error(run.period, cycle_accuracy),
                       Units::attach(with_error(run.amplitude, cycle_accuracy), units.y));
  if (run.outcome == Outcome::undecided) return {};
  if (run.outcome == Outcome::family)
    return fmt::format("It is periodic, one of a family of periodic motions: period {} s, amplitude {}.",
                       with_error(run.period, cycle_accuracy),
                       Units::attach(with_error(run.amplitude, cycle_accuracy), units.y));
  if (run.outcome == Outcome::irregular) return "It moves irregularly.";
  return fmt::format("It comes to {}.", to_string(run.outcome));
}

}  // namespace

Table energy_table(const EnergyBalance& energy) {
  Table table{{{"energy", "", Align::left}, {"", "", Align::left}, {"J", ""}}, {}};
  const auto add = [&](const char* what, const char* where, double value) {
    if (std::abs(value) <= std::numeric_limits<double>::epsilon() * energy.turnover) return;  // zero to rounding
    const bool first =
        table.rows.empty() || std::ranges::none_of(table.rows, [&](const auto& row) { return row[0] == what; });
    table.rows.push_back({first ? what : "", where, with_digits(value, run_digits)});
  };
  if (energy.of_plant) {
    add("supplied", "by the command", energy.command);
    add("supplied", "by the load", energy.load);
    add("supplied", "by what moves the other surface", energy.drive);
  } else {
    add("supplied", "to the friction", energy.rubbing);
  }
  add("stored", "in motion", energy.kinetic);
  add("stored", "in springs and weight", energy.potential);
  add("stored", "in the friction", energy.in_friction);
  add("dissipated", "by dampers", energy.viscous);
  add("dissipated", energy.of_storage ? "by friction" : "by friction (or stored in it)", energy.friction);
  add("dissipated", "at switches, by impulses", energy.impulses);
  return table;
}

std::string energy_in_words(const EnergyBalance& energy) {
  if (!energy.checks()) return "The law does not define its stored energy, so there is no balance to check.";
  const std::string off = fmt::format("{} of {} J turned over", as_error(std::abs(energy.relative_error())),
                                      with_digits(energy.turnover, 4));
  if (energy.balanced()) return fmt::format("The energy balances to {}.", off);
  return fmt::format(
      "Warning: the energy does not balance: it is off by {}, more than the tolerance of the run permits. Try a "
      "smaller "
      "simulate.rtol",
      off);
}

std::string agreement_in_words(const Agreement& second) {
  const std::string other = fmt::format("a second run with rtol = {}", as_error(second.rtol));
  if (!second.agrees)
    return fmt::format("Warning: {} disagrees: {}. {}.", other, second.why,
                       second.rtol < 1e-11 ? "No tolerance settles it: the motion may be chaotic"
                                           : fmt::format("Try --set simulate.rtol={}", as_error(second.rtol)));
  std::string out = fmt::format("Agrees with {}: y at equal phase to {} of its range, its turning points to {} s",
                                other, as_error(second.position_difference), as_error(second.phase_drift));
  if (std::isfinite(second.period_difference))
    out += fmt::format("; period to {}, amplitude to {}", as_error(second.period_difference),
                       as_error(second.amplitude_difference));
  return out + ".";
}

Document simulate_document(const std::string& title, const Simulation& run, const std::optional<Agreement>& second,
                           const std::optional<EnergyBalance>& energy, const Units& units) {
  Document out(wrapped(title) + "\n");
  out += fmt::format("{} samples, {} steps of {}", run.rows.size(), run.steps, run.stepper);
  out += run.status == Status::converged ? ".\n" : fmt::format("; ended early: {}.\n", to_string(run.status));
  if (!run.why.empty()) out += wrapped(run.why);
  if (const auto outcome = outcome_in_words(run, units); !outcome.empty()) out += wrapped(outcome);
  if (second) out += wrapped(agreement_in_words(*second));
  if (energy) {
    out += wrapped(energy_in_words(*energy)) + "\n";
    out.add_untitled("Energy", energy_table(*energy));
  }
  if (!run.rows.empty()) {
    out += "\n";
    out.add_untitled("Ranges", ranges(run, units));
  }
  std::map<std::string, std::size_t> kinds;
  for (const auto& event : run.events) ++kinds[event.what];
  if (!kinds.empty()) out += "\nLocated events\n";
  for (const auto& [what, n] : kinds) out += fmt::format("{:>8}  {}\n", n, what);
  out += notes_text(run.notes);
  return out;
}

std::string simulate_text(const std::string& title, const Simulation& run, const std::optional<Agreement>& second,
                          const std::optional<EnergyBalance>& energy, const Units& units) {
  return simulate_document(title, run, second, energy, units).text();
}

}  // namespace limcycle
