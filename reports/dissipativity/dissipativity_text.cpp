#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/dissipativity/dissipativity.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

std::string joules(double value) { return with_digits(value, 4) + " J"; }

std::string speed_in_words(double speed) {
  return std::isinf(speed) ? "any speed" : "speeds up to " + with_digits(speed, 4) + " m/s";
}

std::string capitalised(std::string text) {
  const bool word = text.size() > 1 && text[1] != ' ';  // not "z rises"
  if (word && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string sentence(std::string text) {
  text = capitalised(std::move(text));
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

/// "from 158.1 N s/m of sigma2 on".
std::string threshold_in_words(const SigmaThreshold& threshold) {
  if (std::isinf(threshold.value)) return "No sigma2 makes it passive.";
  return "It is passive from sigma2 = " +
         with_error(threshold.value, std::max(threshold.error / threshold.value, 1e-6)) + " N s/m on.";
}

std::string limit(double value) { return std::isinf(value) ? "none" : with_digits(value, 6); }

std::string eigenvalue(std::complex<double> value) {
  if (value.imag() == 0.0) return with_digits(value.real(), 4);
  return with_digits(value.real(), 4) + " +- j " + with_digits(std::abs(value.imag()), 4);
}

std::string extent_text(const Extent& extent, int digits = 5) {
  return extent.low == extent.high ? with_digits(extent.low, digits)
                                   : with_digits(extent.low, digits) + " to " + with_digits(extent.high, digits);
}

}  // namespace

std::string dissipativity_answer(const DissipativityReport& report) {
  const Passivity& passivity = report.passivity;
  const std::string who = "The " + report.kind + (report.friction ? " law" : " element");
  const std::string where = !report.friction               ? " from its input to its output"
                            : std::isinf(report.top_speed) ? " from v to F"
                                                           : " from v to F at " + speed_in_words(report.top_speed);
  std::string text;
  if (passivity.passive == Passive::yes)
    text = who + " is passive" + where + ": no motion takes more energy out of it than was put in.";
  else if (passivity.passive == Passive::no)
    text = who + " is not passive" + where + ": a motion takes " + joules(passivity.deficit) +
           " out of it every cycle, without end.";
  else
    text = "Whether the " + report.kind + (report.friction ? " law" : " element") + " is passive" + where +
           " is undecided.";
  if (passivity.passive != Passive::yes && report.threshold) text += " " + threshold_in_words(*report.threshold);
  if (report.loop) {
    const Answer& answer = report.loop->no_cycle;
    if (answer.decision == Decision::yes)
      text += " Energy proves that the loop has no limit cycle.";
    else if (answer.decision != Decision::not_applicable)
      text += " Energy does not prove that the loop has no limit cycle.";
    if (report.agrees)
      text += *report.agrees ? " The search for cycles finds none either." : " However, a cycle was found.";
  }
  return text;
}

Table bound_table(const DissipativityReport& report) {
  Table table{{{"of", "", Align::left},
               {"low", "", Align::right},
               {"high", "", Align::right},
               {"known", "", Align::left},
               {"seen", "", Align::right}},
              {}};
  if (!report.over_all) return table;
  const Bounds& all = *report.over_all;
  for (std::size_t i = 0; i < all.states.size(); ++i) {
    const bool seen = i < all.seen.low.size();
    const double most = seen ? std::max(std::abs(all.seen.low[i]), std::abs(all.seen.high[i])) : 0.0;
    table.rows.push_back({i < report.states.size() ? report.states[i] : "z", limit(all.states[i].low),
                          limit(all.states[i].high), std::string(to_string(all.states[i].kind)),
                          seen ? with_digits(most, 6) : "-"});
  }
  const auto force = [&](const Bounds& bounds, const std::string& name) {
    table.rows.push_back({name, std::isinf(bounds.force.value) ? "none" : with_digits(-bounds.force.value, 6),
                          limit(bounds.force.value), std::string(to_string(bounds.force.kind)),
                          bounds.seen.force > 0.0 ? with_digits(bounds.seen.force, 6) : "-"});
  };
  force(all, "F, " + speed_in_words(report.top_speed));
  if (report.up_to_speed) force(*report.up_to_speed, "F, " + speed_in_words(report.up_to_speed->force.up_to_speed));
  return table;
}

/// A wide interval without a verdict is shown by its ends.
std::string change_in_words(const ThresholdChange& change) {
  constexpr double narrow = 1e-4;
  const double error = std::abs(change.error / change.value);
  if (error <= narrow)
    return fmt::format("passive: {} below, {} above {}", to_string(change.below), to_string(change.above),
                       with_error(change.value, std::max(1e-6, error)));
  return fmt::format("passive: {} up to {}, {} from {}, undecided between", to_string(change.below),
                     with_digits(change.value - change.error, 5), to_string(change.above),
                     with_digits(change.value + change.error, 5));
}

std::vector<std::vector<std::string>> passivity_facts(const DissipativityReport& report) {
  const Passivity& passivity = report.passivity;
  std::vector<std::vector<std::string>> facts{{"passive", std::string(to_string(passivity.passive))},
                                              {"by", passivity.method},
                                              {"why", sentence(passivity.why)}};
  if (passivity.passive == Passive::no) facts.push_back({"deficit", joules(passivity.deficit) + " per cycle"});
  if (std::isfinite(passivity.searched) && passivity.method.find("search") != std::string::npos)
    facts.push_back({"searched", "least energy supplied per cycle: " + joules(passivity.searched)});
  if (report.threshold) facts.push_back({"sigma2", threshold_in_words(*report.threshold)});
  if (report.passive_speed)
    facts.push_back({"speed", std::isinf(report.passive_speed->value) ? "passive at any speed"
                              : report.passive_speed->value == 0.0
                                  ? "not passive at any speed"
                                  : "passive as long as |v| stays below " +
                                        with_error(report.passive_speed->value,
                                                   report.passive_speed->error / report.passive_speed->value) +
                                        " m/s"});
  if (report.range)
    for (const auto& change : report.range->changes) facts.push_back({report.asked->key, change_in_words(change)});
  if (report.range && report.range->changes.empty())
    facts.push_back(
        {report.asked->key, fmt::format("no change from {} to {}: passive: {}", with_digits(report.asked->from, 4),
                                        with_digits(report.asked->to, 4), to_string(report.range->at_low))});
  return facts;
}

Table counterexample_table(const Counterexample& found) {
  Table table{{{"#", "", Align::right}, {"time", "s", Align::right}, {"v", "m/s", Align::right}}, {}};
  for (std::size_t i = 0; i < found.input.time.size(); ++i)
    table.rows.push_back(
        {std::to_string(i), with_digits(found.input.time[i], 6), with_digits(found.input.velocity[i], 6)});
  return table;
}

Table loop_table(const DissipativityReport& report) {
  Table table{{{"question", "", Align::left}, {"answer", "", Align::left}, {"why", "", Align::left}}, {}};
  if (!report.loop) return table;
  const LoopDissipation& loop = *report.loop;
  const auto add = [&](const std::string& question, const Answer& answer) {
    table.rows.push_back({question, std::string(to_string(answer.decision)), sentence(answer.why)});
  };
  add("is the rest of the loop passive?", loop.rest_is_passive);
  add("no cycle, by passivity?", loop.passivity);
  add("no cycle, by the circle criterion?", loop.sector.circle());
  add("no cycle, by Popov's criterion?", loop.sector.popov());
  add("can it stand still?", loop.stuck.answer);
  add("do stuck states attract?", loop.stuck.attracts);
  add("is steady sliding stable?", loop.sliding.stable);
  return table;
}

namespace {

std::string stuck_text(const StuckSet& stuck) {
  if (stuck.answer.decision != Decision::yes) return "";
  std::string text = item("F", 10, extent_text(stuck.force) + " N");
  text += item("y", 10, extent_text(stuck.output));
  text += item("dimension", 10, std::to_string(stuck.dimension));
  if (stuck.tried > 0)
    text += item("marches", 10, fmt::format("{} of {} from nearby came to rest in it", stuck.returned, stuck.tried));
  return "\nStuck states\n" + text;
}

std::string sliding_text(const DissipativityReport& report) {
  const SlidingStability& sliding = report.loop->sliding;
  if (sliding.stable.decision == Decision::not_applicable && report.sliding_changes.empty()) return "";
  std::string text = "\nSteady sliding\n";
  if (sliding.stable.decision != Decision::not_applicable) {
    text +=
        item("velocity", 10, with_digits(sliding.velocity, 6) + " m/s, F = " + with_digits(sliding.force, 6) + " N");
    if (sliding.eigenvalues.size() > 0) text += item("rightmost", 10, eigenvalue(sliding.eigenvalues(0)) + " 1/s");
  }
  for (const auto& point : report.sliding_changes)
    text += item("changes", 10,
                 fmt::format("at {} = {}: {} above, oscillating at {} rad/s", report.speed_of_sliding,
                             with_digits(point.speed, 8), point.stable_above ? "stable" : "unstable",
                             with_digits(point.frequency, 6)));
  if (report.sliding_changes.empty() && !report.speed_of_sliding.empty())
    text += item("changes", 10, "none from a thousandth to a thousand times " + report.speed_of_sliding);
  return text;
}

}  // namespace

Document dissipativity_document(const std::string& title, const DissipativityReport& report) {
  Document text(wrapped(title) + "\n" + wrapped(dissipativity_answer(report)));
  if (report.over_all) text.add("Bounds", bound_table(report));
  text += "\nPassivity\n";
  for (const auto& fact : passivity_facts(report)) text += item(fact[0], 10, fact[1]);
  if (const auto& found = report.passivity.counterexample) {
    text += "\nCounter-example\n" + wrapped(sentence(found->words));
    text.add_untitled("Counter-example", counterexample_table(*found));
    text += item("taken out", 10,
                 joules(found->energy) + " a cycle; by an independent simulation " + joules(found->confirmed));
    if (!found->taken.empty())
      text += item("growth", 10,
                   fmt::format("{} after {} cycles from rest", joules(found->taken.back()), found->taken.size()));
  }
  if (report.loop) {
    std::string questions;
    for (const auto& row : loop_table(report).rows)
      if (row[1] != to_string(Decision::not_applicable))
        questions += item(row[1], 10, capitalised(row[0]) + " " + row[2]);
    if (questions.empty()) questions = wrapped("No question applies: " + sentence(report.loop->passivity.why));
    text += "\nLoop\n" + questions;
    text += stuck_text(report.loop->stuck) + sliding_text(report);
  }
  text += notes_text(report.notes);
  return text;
}

std::string dissipativity_text(const std::string& title, const DissipativityReport& report) {
  return dissipativity_document(title, report).text();
}

}  // namespace limcycle
