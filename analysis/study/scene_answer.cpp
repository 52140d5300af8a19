#include "limcycle/analysis/study/scene_answer.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/frequency/harmonic_balance.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/settle.hpp"
#include "limcycle/analysis/orbit/turning_points.hpp"
#include "limcycle/analysis/study/composite_balance.hpp"
#include "limcycle/analysis/study/cycle_search.hpp"
#include "limcycle/analysis/study/df_roots.hpp"
#include "limcycle/analysis/study/method_names.hpp"
#include "limcycle/analysis/study/output_per_input.hpp"
#include "limcycle/analysis/study/work_point.hpp"
#include "limcycle/models/delay.hpp"

namespace limcycle {
namespace {

/// What methods say that do not tell rest from steady sliding.
constexpr std::string_view no_cycle = "no cycle";

constexpr std::string_view no_start = "no first-harmonic method predicts a cycle to begin from";

/// An oscillation that a first-harmonic method predicts.
struct Oscillation {
  double amplitude = 0.0, frequency = 0.0, input_amplitude = 0.0;
  std::optional<bool> stable;
};

SceneAnswer unanswered(std::string why) {
  SceneAnswer answer;
  answer.why = std::move(why);
  return answer;
}

SearchBox box_of(const Loop& loop, const PredictOptions& options) {
  return options.search.value_or(default_search_box(loop));
}

/// By the describing function; empty with a reason where it does not apply or was not sure.
std::optional<std::vector<Oscillation>> by_describing_function(const Loop& loop, const PredictOptions& options,
                                                               std::string& why) {
  if (const auto reason = LoopBalance::not_applicable(loop)) {
    why = *reason;
    return std::nullopt;
  }
  const LoopBalance balance(loop);
  const DfRoots found = find_df_roots(loop, balance, box_of(loop, options), options.stop);
  std::vector<Oscillation> list;
  for (const Root& root : found.roots)
    list.push_back({balance.output_amplitude(root.amplitude, root.frequency), root.frequency, root.amplitude,
                    balance.stable(root.amplitude, root.frequency, root.index)});
  why = "ended with status " + std::string(to_string(found.status));
  if (list.empty() && found.status != Status::no_cycle && found.status != Status::converged) return std::nullopt;
  return list;
}

std::optional<std::vector<Oscillation>> by_composite(const Loop& loop, const PredictOptions& options,
                                                     std::string& why) {
  if (const auto reason = CompositeBalance::not_applicable(loop)) {
    why = *reason;
    return std::nullopt;
  }
  CompositeSearchOptions search;
  const SearchBox box = box_of(loop, options);
  search.frequency_min = box.frequency_min;
  search.frequency_max = box.frequency_max;
  search.stop = options.stop;
  const CompositeSearch found = CompositeBalance(loop).find(search);
  std::vector<Oscillation> list;
  for (const auto& root : found.roots)
    list.push_back({root.amplitude, root.frequency, root.input_amplitude, root.stable});
  why = "ended with status " + std::string(to_string(found.status));
  if (list.empty() && found.status != Status::no_cycle && found.status != Status::converged) return std::nullopt;
  return list;
}

/// The largest oscillation that is not known to be unstable, as an answer.
SceneAnswer answer_of(const std::vector<Oscillation>& list) {
  SceneAnswer answer;
  answer.answered = true;
  answer.verdict = std::string(no_cycle);
  for (const Oscillation& one : list) {
    if (one.stable == false || one.amplitude <= answer.amplitude) continue;
    answer.verdict = "cycle";
    answer.amplitude = answer.first_harmonic = one.amplitude;
    answer.period = 6.283185307179586 / one.frequency;
  }
  return answer;
}

SceneAnswer ask_balance(const Loop& loop, const PredictOptions& options) {
  std::string why;
  auto list = by_describing_function(loop, options, why);
  if (!list || list->empty()) list = by_composite(loop, options, why);
  if (!list || list->empty()) return unanswered(std::string(no_start));
  SceneAnswer best = answer_of({});
  bool balanced = false;
  for (const Oscillation& root : *list) {
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

/// One plain simulation, watched until its swings repeat.
class SimulationWatch {
 public:
  SimulationWatch(const Loop& loop, const PredictOptions& options, const SearchBox& box)
      : loop_(loop), options_(options), settling_(cycle_search(loop, box, 1e-8)) {
    const auto moduli = pole_moduli(loop);
    horizon_ = 200.0 / (moduli.empty() ? 1.0 : moduli.front());
    longest_ = 25.0 * horizon_;
  }

  SceneAnswer operator()(double displacement) {
    const LoopState start = displaced(loop_, displacement);
    LoopField field(loop_);
    field.modes() = start.modes;
    March march(field, StepperKind::automatic, loop_weights(loop_, settling_.rtol));
    march.begin(start.x, 0.0);
    while (march.t() < horizon_) {
      if (march.steps() > 200000) return unanswered("the simulation gave up after 200000 steps");
      if (options_.stop && march.steps() % 64 == 0 && options_.stop()) return unanswered("interrupted");
      if (const Status status = march.step(longest_); status != Status::converged) return ended(status);
      const double y = field.y(march.x());
      if (std::abs(y) > settling_.amplitude_ceiling) return ended(Status::not_finite);
      if (!turning_.feed(march.t(), y)) continue;
      for (const std::size_t order : {2U, 4U, 6U})
        if (repeats(order)) return cycle(order);
      wait_for_slow_swings(march.t());
    }
    const auto& points = turning_.points();
    const bool calm = points.empty() || points.back().t < 0.5 * march.t() ||
                      (points.size() > 2 && turning_.swing(0) < settling_.amplitude_floor);
    const bool grows = points.size() > 3 && turning_.swing(0) > 10.0 * displacement &&
                       turning_.swing(0) > turning_.swing(1) && turning_.swing(1) > turning_.swing(2);
    if (grows) return ended(Status::not_finite);
    if (!calm) return unanswered("the simulation neither came to rest nor repeated itself");
    SceneAnswer answer;
    answer.answered = true;
    answer.verdict = std::string(no_cycle);
    return answer;
  }

 private:
  static SceneAnswer ended(Status status) {
    if (status != Status::not_finite) return unanswered("ended with status " + std::string(to_string(status)));
    SceneAnswer answer;
    answer.answered = true;
    answer.verdict = "divergence";
    return answer;
  }

  /// Hunting waits long between its slips: at least eight times as long as the last swing took.
  void wait_for_slow_swings(double now) {
    const auto& points = turning_.points();
    if (points.size() > 1)
      horizon_ = std::clamp(now + 8.0 * (points.back().t - points[points.size() - 2].t), horizon_, longest_);
  }

  double length(std::size_t order, std::size_t back) const {
    const auto& points = turning_.points();
    const std::size_t last = points.size() - 1 - back;
    return points[last].t - points[last - order].t;
  }

  /// The last three periods, of `order` turning points each, agree in length and swing.
  bool repeats(std::size_t order) const {
    if (turning_.points().size() < 3 * order + 2) return false;
    for (std::size_t k = 0; k < order; ++k)
      if (std::abs(turning_.swing(k) / turning_.swing(k + order) - 1.0) > agree ||
          std::abs(turning_.swing(k) / turning_.swing(k + 2 * order) - 1.0) > agree)
        return false;
    return std::abs(length(order, 0) / length(order, order) - 1.0) < agree &&
           std::abs(length(order, 0) / length(order, 2 * order) - 1.0) < agree;
  }

  SceneAnswer cycle(std::size_t order) const {
    SceneAnswer answer;
    answer.answered = true;
    answer.verdict = "cycle";
    answer.period = length(order, 0);
    const auto& points = turning_.points();
    double low = points.back().y, high = low;
    for (std::size_t k = 0; k < order; ++k) {
      low = std::min(low, points[points.size() - 1 - k].y);
      high = std::max(high, points[points.size() - 1 - k].y);
    }
    answer.amplitude = 0.5 * (high - low);
    return answer;
  }

  static constexpr double agree = 5e-3;
  const Loop& loop_;
  const PredictOptions& options_;
  SettleOptions settling_;
  double horizon_ = 0.0, longest_ = 0.0;  ///< s
  TurningPoints turning_;
};

/// "cycle/rest" of ends in any order, each as often as it may come.
std::string joined(std::vector<std::string> ends) {
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::string all;
  for (const auto& word : ends) all += (all.empty() ? "" : "/") + word;
  return all;
}

/// A plain simulation from every start that shooting has; the largest cycle counts.
SceneAnswer ask_simulation(const Loop& loop, const PredictOptions& options) {
  const SearchBox box = box_of(loop, options);
  SceneAnswer all;
  std::vector<std::string> ends;
  for (const double displacement : start_displacements(output_per_input(loop), box, options.starts)) {
    SceneAnswer one = SimulationWatch(loop, options, box)(displacement);
    if (!one.answered) return one;
    ends.push_back(one.verdict);
    if (one.amplitude >= all.amplitude) all = std::move(one);
  }
  if (ends.empty()) return unanswered("nothing was simulated");
  all.verdict = joined(std::move(ends));
  return all;
}

SceneAnswer ask_shooting(const Loop& loop, const PredictOptions& options) {
  PredictOptions only_time = options;
  only_time.methods = {.describing_function = false, .composite = false, .harmonic_balance = false};
  only_time.nyquist = false;
  only_time.progress = {};
  const PredictReport report = predict(loop, only_time);
  SceneAnswer answer;
  std::vector<std::string> ends;
  for (const auto& one : report.outcomes) {
    const std::string word(to_string(one.outcome));
    if (one.outcome == Outcome::undecided) return unanswered("undecided from " + one.start + ": " + one.why);
    ends.push_back(word);
  }
  if (ends.empty()) return unanswered("nothing was simulated");
  answer.verdict = joined(std::move(ends));
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

SceneAnswer ask(const std::string& method, const Loop& loop, const PredictOptions& options) {
  if (method == simulation_name) return ask_simulation(loop, options);
  if (method == shooting_name) return ask_shooting(loop, options);
  if (method == balance_name) return ask_balance(loop, options);
  std::string why;
  const auto list =
      method == composite_name ? by_composite(loop, options, why) : by_describing_function(loop, options, why);
  return list ? answer_of(*list) : unanswered(why);
}

/// A verdict as one tells it that does not know rest from steady sliding.
std::string without_kinds_of_calm(const std::string& verdict) {
  std::vector<std::string> ends;
  for (std::size_t from = 0; from <= verdict.size();) {
    const std::size_t to = std::min(verdict.find('/', from), verdict.size());
    const std::string word = verdict.substr(from, to - from);
    ends.push_back(word == "rest" || word == "sliding" ? std::string(no_cycle) : word);
    from = to + 1;
  }
  return joined(std::move(ends));
}

}  // namespace

const std::vector<std::string>& scene_methods() {
  static const std::vector<std::string> names{std::string(df_name), std::string(composite_name),
                                              std::string(balance_name), std::string(simulation_name),
                                              std::string(shooting_name)};
  return names;
}

SceneAnswer balance_without_start() {
  SceneAnswer answer = unanswered(std::string(no_start));
  answer.seconds = not_known;
  return answer;
}

SceneAnswer ask_scene(const std::string& method, const Loop& loop, const PredictOptions& options) {
  const double begin = cpu_seconds();
  SceneAnswer answer;
  try {
    answer = ask(method, loop, options);
  } catch (const std::invalid_argument& error) {
    answer = unanswered(error.what());  // the method does not take this law
  }
  answer.seconds = cpu_seconds() - begin;
  return answer;
}

double scene_error(const std::string& method, const SceneAnswer& answer, const SceneAnswer& best) {
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
