#include "limcycle/analysis/study/adequacy/method_answers.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "limcycle/analysis/frequency/harmonic_balance/harmonic_balance.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/adequacy/scene_simulation.hpp"
#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/composite/composite_balance.hpp"
#include "limcycle/analysis/study/precision/work_precision.hpp"
#include "limcycle/analysis/study/predict/method_names.hpp"
#include "limcycle/analysis/study/predict/work_share.hpp"

namespace limcycle {
namespace {

using Roots = MethodQuestions::Roots;

SearchBox box_of(const Loop& loop, const PredictOptions& options) {
  return options.search.value_or(default_search_box(loop));
}

/// A search that may be incomplete and found no roots gives no answer.
void conclude(Roots& roots, Status status) {
  roots.interrupted = status == Status::interrupted;
  roots.answered = !roots.list.empty() || status == Status::no_cycle || status == Status::converged;
  if (!roots.answered) roots.why = "ended with status " + std::string(to_string(status));
}

Roots by_describing_function(const Loop& loop, const PredictOptions& options) {
  Roots roots;
  if (const auto reason = FirstHarmonicBalance::not_applicable(loop)) {
    roots.why = *reason;
    return roots;
  }
  const FirstHarmonicBalance balance(loop);
  const DfRoots found = find_df_roots(loop, balance, box_of(loop, options), options.stop);
  for (const Root& root : found.roots)
    roots.list.push_back({balance.output_amplitude(root.amplitude, root.frequency), root.frequency, root.amplitude,
                          balance.stable(root.amplitude, root.frequency, root.index)});
  conclude(roots, found.status);
  return roots;
}

Roots by_composite(const Loop& loop, const PredictOptions& options) {
  Roots roots;
  if (const auto reason = CompositeBalance::not_applicable(loop)) {
    roots.why = *reason;
    return roots;
  }
  CompositeSearchOptions search;
  const SearchBox box = box_of(loop, options);
  search.frequency_min = box.frequency_min;
  search.frequency_max = box.frequency_max;
  search.max_steps = work_share(0).composite_steps;
  search.stop = options.stop;
  const CompositeSearch found = CompositeBalance(loop).find(search);
  for (const auto& root : found.roots)
    roots.list.push_back({root.amplitude, root.frequency, root.input_amplitude, root.stable});
  conclude(roots, found.status);
  return roots;
}

/// The largest oscillation that is not known to be unstable, as an answer.
MethodAnswer answer_of(const std::vector<MethodQuestions::Oscillation>& list) {
  MethodAnswer answer;
  answer.answered = true;
  answer.verdict = std::string(no_cycle_verdict);
  for (const auto& one : list) {
    if (one.stable == false || one.amplitude <= answer.amplitude) continue;
    answer.verdict = "cycle";
    answer.amplitude = answer.first_harmonic = one.amplitude;
    answer.period = 6.283185307179586 / one.frequency;
  }
  return answer;
}

MethodAnswer ask_balance(const Loop& loop, const std::vector<MethodQuestions::Oscillation>& starts,
                         const PredictOptions& options) {
  MethodAnswer best = answer_of({});
  bool balanced = false;
  for (const auto& root : starts) {
    HarmonicBalanceOptions balance;
    balance.max_evaluations = 200'000;
    balance.stop = options.stop;
    HarmonicGuess guess{root.frequency, Eigen::VectorXcd::Zero(std::ssize(loop.elements)), {}, {}};
    guess.first(guess.first.size() - 1) = root.input_amplitude;
    const HarmonicBalance found = harmonic_balance(loop, guess, balance);
    if (found.harmonics < 3 || !(found.residual < 1e-6)) continue;
    balanced = true;
    if (root.stable == false || found.amplitude <= best.amplitude) continue;
    best.verdict = "cycle";
    best.amplitude = found.amplitude;
    best.first_harmonic = found.first_harmonic;
    best.period = 6.283185307179586 / found.frequency;
  }
  return balanced ? best : unanswered("no balance was found from the roots of the first harmonic");
}

MethodAnswer ask_shooting(const Loop& loop, const PredictOptions& options) {
  PredictOptions only_time = options;
  only_time.methods = {.describing_function = false, .composite = false, .harmonic_balance = false};
  only_time.load_step = false;  // so that the plain simulation has the same starts
  only_time.progress = {};
  const PredictReport report = predict(loop, only_time);
  MethodAnswer answer;
  std::vector<std::string> ends;
  for (const auto& one : report.outcomes) {
    const std::string word(to_string(one.outcome));
    if (one.outcome == Outcome::undecided) return unanswered("undecided from " + one.start + ": " + one.why);
    ends.push_back(word);
  }
  if (ends.empty()) return unanswered("nothing was simulated");
  answer.verdict = joined_verdict(std::move(ends));
  answer.answered = true;
  for (const Cycle& cycle : report.cycles) {
    if (cycle.stable != true || cycle.amplitude <= answer.amplitude) continue;
    answer.period = cycle.period;
    answer.amplitude = cycle.amplitude;
    answer.first_harmonic = cycle.first_harmonic;
    answer.error = cycle.error;
    answer.cycle = cycle;
  }
  return answer;
}

/// The verdict of a method that does not distinguish rest from steady sliding.
std::string without_kinds_of_calm(const std::string& verdict) {
  std::vector<std::string> ends;
  for (std::size_t from = 0; from <= verdict.size();) {
    const std::size_t to = std::min(verdict.find('/', from), verdict.size());
    const std::string word = verdict.substr(from, to - from);
    ends.push_back(word == "rest" || word == "sliding" ? std::string(no_cycle_verdict) : word);
    from = to + 1;
  }
  return joined_verdict(std::move(ends));
}

}  // namespace

const std::vector<std::string>& answering_methods() {
  static const std::vector<std::string> names{std::string(df_name), std::string(composite_name),
                                              std::string(balance_name), std::string(simulation_name),
                                              std::string(shooting_name)};
  return names;
}

MethodAnswer unanswered(std::string why) {
  MethodAnswer answer;
  answer.why = std::move(why);
  return answer;
}

std::string joined_verdict(std::vector<std::string> ends) {
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::string all;
  for (const auto& word : ends) all += (all.empty() ? "" : "/") + word;
  return all;
}

MethodAnswer not_asked(std::string why) {
  MethodAnswer answer = unanswered(std::move(why));
  answer.seconds = not_known;
  return answer;
}

MethodQuestions::MethodQuestions(Loop loop, PredictOptions options)
    : loop_(std::move(loop)), options_(std::move(options)) {}

MethodAnswer MethodQuestions::ask(const std::string& method, double patience) {
  const double begin = cpu_seconds();
  borrowed_ = 0.0;
  patience_ = patience;
  const auto passed = [&] { return cpu_seconds() - begin + borrowed_; };
  constexpr unsigned clock_every = 16;  // reading the clock takes as long as a cheap step
  std::atomic<unsigned> asked = 0;
  std::atomic<bool> late = false;
  PredictOptions options = options_;
  options.stop = [&] {
    if (asked++ % clock_every == 0 && passed() > patience) late = true;
    return late || (options_.stop && options_.stop());
  };
  MethodAnswer answer;
  try {
    answer = answer_by(method, options);
  } catch (const std::invalid_argument& error) {
    answer = unanswered(error.what());  // the method does not accept this law
  }
  answer.seconds = passed();
  if (answer.seconds > patience) {
    answer.answered = false;
    answer.why = "stopped after " + short_number(patience) + " s of CPU time";
  }
  return answer;
}

MethodAnswer MethodQuestions::answer_by(const std::string& method, const PredictOptions& options) {
  if (method == simulation_name) return plain_simulation(loop_, options, box_of(loop_, options));
  if (method == shooting_name) return ask_shooting(loop_, options);
  if (method == balance_name) {
    const Roots* starts = &roots(describing_function_, by_describing_function, options);
    if (starts->list.empty()) starts = &roots(composite_, by_composite, options);
    return starts->list.empty() ? unanswered("no first-harmonic method predicts a cycle to begin from")
                                : ask_balance(loop_, starts->list, options);
  }
  const Roots& found = method == composite_name ? roots(composite_, by_composite, options)
                                                : roots(describing_function_, by_describing_function, options);
  return found.answered ? answer_of(found.list) : unanswered(found.why);
}

const MethodQuestions::Roots& MethodQuestions::roots(
    std::optional<Roots>& known, const std::function<Roots(const Loop&, const PredictOptions&)>& search,
    const PredictOptions& options) {
  if (known && !(known->interrupted && known->seconds < patience_)) {
    borrowed_ += known->seconds;
    return *known;
  }
  const double begin = cpu_seconds();
  known = search(loop_, options);
  known->seconds = cpu_seconds() - begin;
  return *known;
}

MethodAnswer ask_scene(const std::string& method, const Loop& loop, const PredictOptions& options) {
  return MethodQuestions(loop, options).ask(method);
}

double scene_error(const std::string& method, const MethodAnswer& answer, const MethodAnswer& best) {
  if (!answer.answered || !best.answered) return not_known;
  bool same = answer.verdict == best.verdict;
  if (method == simulation_name)
    same = answer.verdict == without_kinds_of_calm(best.verdict);
  else if (method != shooting_name)
    same = answer.hunts() == best.hunts();  // roots of the whole box
  if (!same || answer.hunts() != (answer.period > 0.0)) return infinite;
  if (!answer.hunts()) return 0.0;
  const bool first = method == df_name || method == composite_name;
  const double amplitude = first ? answer.first_harmonic / best.first_harmonic : answer.amplitude / best.amplitude;
  return std::max(std::abs(answer.period / best.period - 1.0), std::abs(amplitude - 1.0));
}

}  // namespace limcycle
