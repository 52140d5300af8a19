#include "limcycle/reports/predict/verdict_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/predict/interest.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/words.hpp"

namespace limcycle {
namespace {

constexpr int sentence_digits = 4;  // in sentences; the tables show all accurate digits

std::string counted(std::size_t n, const std::string& noun) {
  return n == 1 ? "one " + noun : fmt::format("{} {}s", n, noun);
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string size_of(const Cycle& cycle, const Units& units) {
  return fmt::format("period {} s and amplitude {}", with_digits(cycle.period, sentence_digits),
                     Units::attach(with_digits(cycle.amplitude, sentence_digits), units.y));
}

std::size_t count(const PredictReport& report, Outcome outcome) {
  return static_cast<std::size_t>(std::count_if(report.outcomes.begin(), report.outcomes.end(),
                                                [&](const auto& one) { return one.outcome == outcome; }));
}

std::string phrase(Outcome outcome) {
  switch (outcome) {
    case Outcome::rest:
      return "comes to rest";
    case Outcome::sliding:
      return "ends in steady sliding";
    case Outcome::cycle:
      return "reaches a limit cycle";
    case Outcome::divergence:
      return "diverges";
    case Outcome::family:
      return "oscillates with an amplitude that depends on the start";
    case Outcome::irregular:
      return "moves irregularly";
    case Outcome::undecided:
      return "is undecided";
  }
  return "is undecided";
}

/// "from all 4 starts it comes to rest", or the outcomes with their counts.
std::string fates(const PredictReport& report) {
  const std::size_t n = report.outcomes.size();
  std::string out;
  for (const Outcome outcome : {Outcome::cycle, Outcome::family, Outcome::irregular, Outcome::rest, Outcome::sliding,
                                Outcome::divergence, Outcome::undecided}) {
    const std::size_t k = count(report, outcome);
    if (k == 0) continue;
    if (k == n)
      return n == 1 ? "from its only start it " + phrase(outcome)
                    : fmt::format("from all {} starts it {}", n, phrase(outcome));
    out += (out.empty() ? "" : ", ") + fmt::format("from {} of {} starts it {}", k, n, phrase(outcome));
  }
  return out;
}

/// "between -0.88 m and 0.88 m", for the largest irregular motion.
std::string irregular_size(const PredictReport& report, const Units& units) {
  const auto largest =
      std::ranges::max_element(report.outcomes, {}, [](const OutcomeOfStart& one) { return one.irregular.half_range; });
  const IrregularMotion& motion = largest->irregular;
  int digits = 4;  // and as many as tell the shortest period from the longest
  constexpr int most_digits = 8;
  while (digits < most_digits &&
         with_digits(motion.shortest_period, digits) == with_digits(motion.longest_period, digits))
    ++digits;
  const bool always = count(report, Outcome::irregular) == report.outcomes.size();
  const std::string beat = motion.beat_frequency > 0.0
                               ? fmt::format(" Against the samples it beats once in {} s.",
                                             with_digits(2.0 * std::numbers::pi / motion.beat_frequency, 2))
                               : "";
  return fmt::format(" {}: half-range {}, mean period {} s, single ones from {} to {} s over {} s.{}",
                     always ? "It never comes to rest" : "Where it moves",
                     Units::attach(with_digits(motion.half_range, 3), units.y), with_digits(motion.mean_period, digits),
                     with_digits(motion.shortest_period, digits), with_digits(motion.longest_period, digits),
                     with_digits(motion.observed, 2), beat);
}

std::string without_cycle(const PredictReport& report, const Units& units) {
  if (report.outcomes.empty()) return "Not verified in the time domain.";
  if (count(report, Outcome::undecided) > 0 && count(report, Outcome::irregular) == 0)
    return "Whether this loop has a limit cycle is undecided: " + fates(report) + ".";
  if (count(report, Outcome::irregular) > 0 && report.sample_time > 0.0)
    return "This loop hunts, without a period that is locked to its samples: " + fates(report) + "." +
           irregular_size(report, units);
  if (count(report, Outcome::irregular) > 0)
    return "This loop moves irregularly, without a period: " + fates(report) + "." + irregular_size(report, units);
  if (count(report, Outcome::family) > 0) return "This loop oscillates without a limit cycle: " + fates(report) + ".";
  if (count(report, Outcome::divergence) > 0) return "This loop shows no limit cycle: " + fates(report) + ".";
  return "This loop does not hunt: " + fates(report) + ".";
}

std::string with_cycles(const PredictReport& report, const Units& units) {
  std::vector<const Cycle*> stable, others;
  for (const auto& cycle : report.cycles)
    if (is_of_interest(report.search, cycle)) (cycle.stable.value_or(false) ? stable : others).push_back(&cycle);
  std::string out;
  if (stable.empty() && others.empty()) {
    const Cycle& first = report.cycles.front();
    return fmt::format("This loop does not hunt within the search range: its limit cycle of {} is outside it{}.",
                       size_of(first, units),
                       report.cycles.size() > 1 ? fmt::format(" (as are {} more)", report.cycles.size() - 1) : "");
  }
  if (stable.empty() && count(report, Outcome::irregular) > 0) {
    out = fmt::format("{} {} limit cycle of {} is not reached", without_cycle(report, units),
                      others.front()->stable.has_value() ? "An unstable" : "A", size_of(*others.front(), units));
    return out + (others.size() > 1 ? fmt::format(" (nor are {} more).", others.size() - 1) : ".");
  }
  if (stable.empty()) {
    const bool unstable = others.front()->stable.has_value();
    out = fmt::format("This loop has a limit cycle of {}, {}", size_of(*others.front(), units),
                      unstable ? "but it is unstable" : "but its stability was not determined");
    if (others.size() > 1) out += fmt::format(" (and {} more)", others.size() - 1);
    return out + (report.outcomes.empty() ? "." : "; " + fates(report) + ".");
  }
  const bool sticks = std::any_of(stable.begin(), stable.end(), [](auto* c) { return c->sticking_fraction > 0.0; });
  out = sticks ? "This loop hunts: it " : "This loop oscillates: it ";
  if (stable.size() == 1) {
    out += "settles into a limit cycle of " + size_of(*stable[0], units) + ".";
  } else {
    std::vector<std::string> sizes;
    sizes.reserve(stable.size());
    for (const Cycle* one : stable) sizes.push_back(size_of(*one, units));
    out += fmt::format("has {} stable limit cycles, of {}.", stable.size(), listed_in_words(sizes));
  }
  if (std::ranges::any_of(stable, [](auto* c) { return c->remembered > 0; }))
    out += stable.size() == 1
               ? " It is one of a family of such cycles: the loop keeps a part of its history, which decides which."
               : " Some are of a family of such cycles: the loop keeps a part of its history, which decides which.";
  const bool decided = std::all_of(others.begin(), others.end(), [](auto* c) { return c->stable.has_value(); });
  if (!others.empty())
    out += fmt::format(" {} {}.", others.size() == 1 ? "One more is" : fmt::format("{} more are", others.size()),
                       decided ? "unstable" : "not stable or undecided");
  if (count(report, Outcome::cycle) < report.outcomes.size()) out += " " + capital(fates(report)) + ".";
  return out;
}

/// "2.4 % too low": deviation of a prediction from the true value.
std::string deviation(double predicted, double truth) {
  const double share = 100.0 * (predicted - truth) / truth;
  if (!std::isfinite(share)) return "not comparable";
  if (std::abs(share) < 0.01) return "right within 0.01 %";
  return fmt::format("{} % too {}", with_digits(std::abs(share), 2), share > 0.0 ? "high" : "low");
}

/// Name of a cycle in a sentence; if there are several, it identifies the cycle.
std::string name_of(const PredictReport& report, const Cycle& cycle) {
  if (report.cycles.size() == 1) return "it";
  const std::string kind = cycle.stable ? (*cycle.stable ? "stable " : "unstable ") : "";
  return fmt::format("the {}cycle of period {} s", kind, with_digits(cycle.period, sentence_digits));
}

std::string of_one(const PredictReport& report, const Prediction& one, const Units& units) {
  const std::string size = fmt::format("amplitude {}, frequency {} rad/s",
                                       Units::attach(with_digits(one.amplitude, sentence_digits), units.y),
                                       with_digits(one.frequency, sentence_digits));
  if (one.verdict == Verdict::wrong) return "predicts a limit cycle (" + size + ") that does not exist";
  if (one.motion) {
    const std::string of_size = deviation(one.amplitude, one.motion->mean_amplitude),
                      of_speed = deviation(one.frequency, 2.0 * std::numbers::pi / one.motion->mean_period);
    if (one.verdict == Verdict::biased)
      return fmt::format("finds this motion on the mean, but the amplitude is {} and the frequency {}", of_size,
                         of_speed);
    return fmt::format("finds this motion on the mean: amplitude {}, frequency {}", of_size, of_speed);
  }
  if (one.verdict == Verdict::undecided || !one.cycle || *one.cycle >= report.cycles.size())
    return "predicts a limit cycle (" + size + "), which is unverified";
  const Cycle& cycle = report.cycles[*one.cycle];
  const std::string name = name_of(report, cycle);
  const std::string amplitude = deviation(one.amplitude, cycle.first_harmonic);
  const std::string frequency = deviation(one.frequency, cycle.frequency());
  if (one.verdict == Verdict::biased)
    return fmt::format("finds {}, but the amplitude is {} and the frequency {}", name, amplitude, frequency);
  return fmt::format("finds {}: amplitude {}, frequency {}", name, amplitude, frequency);
}

std::string of_many(const std::vector<const Prediction*>& predictions) {
  std::string out = fmt::format("predicts {}:", counted(predictions.size(), "limit cycle"));
  bool first = true;
  for (const Verdict verdict : {Verdict::confirmed, Verdict::biased, Verdict::wrong, Verdict::undecided}) {
    const auto k =
        std::count_if(predictions.begin(), predictions.end(), [&](auto* p) { return p->verdict == verdict; });
    if (k == 0) continue;
    out += fmt::format("{} {} {}", first ? "" : ",", k, to_string(verdict));
    first = false;
  }
  return out;
}

std::string worth_of(const std::string& method, const PredictReport& report, const Units& units) {
  std::vector<const Prediction*> own;
  for (const auto& one : report.predictions)
    if (one.method == method) own.push_back(&one);
  const auto missed = static_cast<std::size_t>(
      std::count_if(report.missed.begin(), report.missed.end(), [&](const auto& one) { return one.method == method; }));
  const std::string subject = capital(method_in_words(method)) + " ";
  const bool complete = searched_completely(report, method);
  const std::string which = report.cycles.size() == 1 ? "this cycle" : counted(missed, "limit cycle");
  if (own.empty() && !complete)
    return subject + "found no limit cycle, but its search was incomplete" +
           (missed > 0 ? ": it may have missed " + which + "." : ".");
  if (own.empty() && missed == 0) {
    if (report.cycles.empty() && count(report, Outcome::irregular) > 0) return subject + "does not see this motion.";
    const bool agrees = report.cycles.empty() && count(report, Outcome::undecided) == 0;
    return subject + (agrees ? "predicts none either." : "predicts no limit cycle in the search box.");
  }
  // Harmonic balance starts from results of other methods and searches no box; it does not try a cycle that sticks.
  const bool searches = method != "harmonic-balance";
  if (own.empty() && missed == report.cycles.size())
    return subject + (!searches                   ? "finds no cycle here."
                      : report.cycles.size() == 1 ? "does not find this cycle."
                                                  : "finds none of the " + which + ".");
  if (own.empty()) return subject + "does not find " + which + ".";
  std::string out = subject + (own.size() == 1 ? of_one(report, *own[0], units) : of_many(own));
  if (missed > 0)
    out += (complete ? "; it does not find " : "; it has not found ") +
           (report.cycles.size() == 1                  ? "the cycle that exists"
            : report.cycles.size() == 2 && missed == 1 ? "the other cycle"
                                                       : which);
  return out + (complete ? "." : "; its search was incomplete, so it may predict more.");
}

}  // namespace

std::string method_in_words(const std::string& method) {
  if (method == "describing-function") return "the describing function";
  if (method == "composite-describing-function") return "the composite describing function";
  if (method == "harmonic-balance") return "harmonic balance";
  return method;
}

VerdictText answer(const PredictReport& report, const Units& units) {
  VerdictText out;
  out.what_happens = report.cycles.empty() ? without_cycle(report, units) : with_cycles(report, units);
  if (report.status == Status::interrupted)
    out.what_happens = report.cycles.empty() && report.outcomes.empty()
                           ? "Interrupted before verification in the time domain."
                           : "Interrupted; partial result: " + out.what_happens;
  if (report.cause) out.what_happens += " " + report.cause->why + " limcycle remedy looks for changes that end it.";
  std::vector<std::string> methods;
  const auto add = [&](const std::string& method) {
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) methods.push_back(method);
  };
  // It is judged without roots too; where it does not exist the notes say so.
  if (report.describing_function) add("describing-function");
  for (const auto& one : report.predictions) add(one.method);
  for (const auto& one : report.missed) add(one.method);
  for (const auto& method : report.unfinished) {
    std::erase(methods, method);
    const auto found = std::ranges::count(report.predictions, method, &Prediction::method);
    out.worth.push_back(fmt::format("{} was interrupted after {}: it may predict more.",
                                    capital(method_in_words(method)),
                                    counted(static_cast<std::size_t>(found), "prediction")));
  }
  for (const auto& method : methods) out.worth.push_back(worth_of(method, report, units));
  return out;
}

}  // namespace limcycle
