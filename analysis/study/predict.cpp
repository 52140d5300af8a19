#include "limcycle/analysis/study/predict.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <future>
#include <map>
#include <numbers>

#include "limcycle/analysis/derivative_notes.hpp"
#include "limcycle/analysis/frequency/harmonic_balance.hpp"
#include "limcycle/analysis/orbit/measure.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/composite_balance.hpp"
#include "limcycle/analysis/study/cycle_hunt.hpp"
#include "limcycle/analysis/study/df_predictions.hpp"
#include "limcycle/analysis/study/interest.hpp"
#include "limcycle/analysis/study/method_names.hpp"
#include "limcycle/analysis/study/orbit_guess.hpp"
#include "limcycle/analysis/study/output_per_input.hpp"
#include "limcycle/analysis/study/verdicts.hpp"
#include "limcycle/models/delay.hpp"

namespace limcycle {
namespace {

/// The loop as the time domain can treat it, and a note of what was done to a delay: the Pade approximation is right to
/// 1e-9 up to the seventh harmonic of the fastest prediction.
TimeDomainLoop treat_in_time(const Loop& loop, const PredictReport& report, std::vector<std::string>& notes) {
  if (loop.delay == 0.0) return {loop, 0, 0};
  double highest = 0.0;
  for (const Prediction& p : report.predictions) highest = std::max(highest, 7.0 * p.frequency);
  if (highest == 0.0) highest = 7.0 / loop.delay;
  highest = std::min(highest, 40.0 / loop.delay);
  int order = lowest_pade_order;
  while (order < highest_pade_order && pade_error(highest, loop.delay, order) > 1e-9) ++order;
  auto treated = in_time_domain(loop, order);
  notes.push_back(
      treated.pade_order == 0
          ? "the delay is exact in the frequency domain and, acting on a relay's switches, in the time domain too"
          : "the delay is exact in the frequency domain; in the time domain it is a Pade approximation of order " +
                std::to_string(order) + "/" + std::to_string(order) + ", off by at most " +
                short_number(pade_error(highest, loop.delay, order)) + " of the delayed signal up to " +
                short_number(highest) + " rad/s");
  return treated;
}

constexpr double settled = 0.05;  ///< relative change of an answer by the last harmonics that were added to it

/// The work of one prediction, step by step, so that what is finished stays when the user interrupts.
class PredictionStudy {
 public:
  PredictionStudy(const Loop& loop, const PredictOptions& options)
      : loop_(loop), options_(options), box_(options.search.value_or(default_search_box(loop))) {
    report_.search = box_;
  }

  PredictReport run() {
    if (options_.methods.composite) begin_composite();
    if (options_.methods.describing_function) begin_df();
    if (loop_.delay > 0.0) end_df();  // what is predicted tells how well the delay must be approximated
    auto treated = treat_in_time(loop_, report_, report_.notes);
    time_ = std::move(treated.loop);
    pade_order_ = treated.pade_order;
    hunt_.emplace(time_, options_, box_);
    if (hunt_->rtol() < SettleOptions{}.rtol)
      report_.notes.push_back("bristles as stiff as these need a tolerance of " + short_number(hunt_->rtol(), 2) +
                              " in simulations (usual is " + short_number(SettleOptions{}.rtol) +
                              "): a looser one breaks stiction early");
    run_starts();
    end_df();
    end_composite();
    for (std::size_t i = 0; i < report_.predictions.size() && !stopped(); ++i) check(report_.predictions[i], i);
    if (options_.methods.harmonic_balance && !stopped()) balance_harmonics();
    finish();
    return std::move(report_);
  }

 private:
  bool stopped() const { return options_.stop && options_.stop(); }
  void tell(double fraction, std::string_view what) const {
    if (options_.progress) options_.progress(fraction, what);
  }

  /// The search for roots of 1 + N G runs beside the simulations: neither needs the other.
  void begin_df() {
    if (const auto why = LoopBalance::not_applicable(loop_)) {
      report_.notes.push_back(*why);
      return;
    }
    balance_.emplace(loop_);
    df_search_ = std::async(std::launch::async, [this] { return df_predictions(loop_, *balance_, box_, options_); });
  }

  void end_df() {
    if (!df_search_.valid()) return;
    tell(0.6, "roots of 1 + N G");
    DfPredictions found = df_search_.get();
    report_.notes.insert(report_.notes.begin(), found.notes.begin(), found.notes.end());
    if (found.status != Status::converged) report_.status = found.status;
    if (found.status == Status::incomplete || found.status == Status::not_finite)
      report_.incomplete.emplace_back(df_name);
    report_.predictions = std::move(found.predictions);
    report_.absence = std::move(found.absence);
    report_.nyquist = std::move(found.nyquist);
    report_.efforts.push_back({std::string(df_name), 0, {}});
    (found.status == Status::interrupted ? report_.unfinished : used_).emplace_back(df_name);
  }

  /// The search with mass and friction as one element runs beside the simulations: neither needs the other.
  void begin_composite() {
    if (loop_.delay > 0.0 || CompositeBalance::not_applicable(loop_) || stopped()) return;
    composite_.emplace(loop_);
    CompositeSearchOptions options;
    options.frequency_min = box_.frequency_min;
    options.frequency_max = box_.frequency_max;
    options.stop = options_.stop;
    composite_search_ = std::async(std::launch::async, [this, options] { return composite_->find(options); });
  }

  void end_composite() {
    if (!composite_search_.valid()) return;
    tell(0.65, "mass and friction as one element");
    auto found = composite_search_.get();
    report_.notes.insert(report_.notes.end(), found.notes.begin(), found.notes.end());
    for (const CompositeRoot& root : found.roots) {
      Prediction p;
      p.method = composite_name;
      p.input_amplitude = root.input_amplitude;
      p.amplitude = root.amplitude;
      p.frequency = root.frequency;
      p.residual = root.residual;
      p.stable = root.stable;
      composite_roots_[report_.predictions.size()] = root;
      report_.predictions.push_back(std::move(p));
    }
    report_.efforts.push_back({std::string(composite_name), found.evaluations, "periods of mass and friction"});
    if (found.status == Status::incomplete) report_.incomplete.emplace_back(composite_name);
    (found.status == Status::interrupted ? report_.unfinished : used_).emplace_back(composite_name);
  }

  void run_starts() {
    double done = 0.0;
    for (const double displacement : start_displacements(output_per_input(time_), box_, options_.starts)) {
      if (stopped()) return;
      tell(0.2 + 0.4 * done++ / std::max(1, options_.starts), "simulation");
      hunt_->settle_from(displaced(time_, displacement), "y displaced by " + short_number(displacement));
    }
  }

  /// Linear states on an oscillation of the plain balance, of the loop that is treated in time.
  Eigen::VectorXd linear_state(const Prediction& p, double phase, double scale) const {
    return LoopBalance(time_).linear_state(p.input_amplitude, p.frequency, phase, scale);
  }

  LoopState start_of(const Prediction& p, std::size_t index) {
    const auto root = composite_roots_.find(index);
    if (root != composite_roots_.end()) return composite_->state(root->second);
    return without_history(time_, linear_state(p, 0.0, 1.0));
  }

  /// What a prediction is worth: go to the predicted oscillation and see what the loop does there.
  void check(Prediction& p, std::size_t index) {
    tell(0.7 + 0.2 * static_cast<double>(index) / static_cast<double>(report_.predictions.size()),
         "checking predictions");
    const bool plain = p.method == df_name;
    if (plain && p.stable != true && unstable_cycle_near(p)) return;
    const auto& outcome =
        hunt_->settle_from(start_of(p, index), "the oscillation predicted by root " + std::to_string(index));
    // What a stable prediction leads to is what it is about, unless it is absurdly far from it.
    if (outcome.cycle && p.stable != false && nearest({hunt_->cycles()[*outcome.cycle]}, p))
      return compare(p, hunt_->cycles(), *outcome.cycle);
    if (const auto cycle = nearest(hunt_->cycles(), p);
        cycle && (!p.stable || hunt_->cycles()[*cycle].stable == p.stable))
      return compare(p, hunt_->cycles(), *cycle);
    conclude_without_cycle(p, outcome);
  }

  static void conclude_without_cycle(Prediction& p, const OutcomeOfStart& outcome) {
    const bool decided = outcome.outcome != Outcome::undecided;
    if (p.stable == true && decided) {
      p.verdict = Verdict::wrong;
      p.why = "no such cycle: a motion started on it ends in " + std::string(to_string(outcome.outcome));
    } else {
      p.why = p.stable == true ? "the simulation from it was not decided"
                               : "no unstable cycle was found near it, none was excluded";
    }
  }

  /// Newton for the cycle from the predicted oscillation itself, without letting the motion run away first; if that
  /// ends elsewhere, the border between what larger and smaller oscillations lead to.
  bool unstable_cycle_near(Prediction& p) {
    const bool odd = symmetry(time_).has_value();
    const auto accept = [&](std::optional<std::size_t> cycle) {
      if (!cycle || hunt_->cycles()[*cycle].stable != false || !nearest({hunt_->cycles()[*cycle]}, p)) return false;
      compare(p, hunt_->cycles(), *cycle);
      return true;
    };
    for (const double scale : {1.0, 0.9, 1.1}) {
      if (stopped()) return false;
      const auto states = [&](double phase) { return linear_state(p, phase, scale); };
      if (accept(hunt_->shoot_from(guess_orbit(time_, states, p.frequency, odd)))) return true;
    }
    const auto ray = [&](double scale) { return without_history(time_, linear_state(p, 0.0, scale)); };
    return !stopped() && accept(hunt_->edge_along(ray, 2.0 * std::numbers::pi / p.frequency));
  }

  /// Harmonic balance from every root of the plain describing function, and from every cycle it missed.
  void balance_harmonics() {
    tell(0.9, "harmonic balance");
    HarmonicBalanceOptions options;
    options.half_wave_symmetric = symmetry(loop_).has_value();
    options.max_evaluations = 200'000;
    options.stop = options_.stop;
    const auto ne = std::ssize(loop_.elements);
    std::vector<HarmonicGuess> guesses;
    for (const Prediction& p : report_.predictions) {
      if (p.method != df_name) continue;
      HarmonicGuess guess{p.frequency, Eigen::VectorXcd::Zero(ne), {}, {}};
      guess.first(ne - 1) = p.input_amplitude;
      if (ne > 1) guess.mean = balance_->mean_inputs(p.input_amplitude, p.frequency, 1e-9);
      guesses.push_back(std::move(guess));
    }
    for (std::size_t i = 0; i < hunt_->cycles().size(); ++i) {
      const Cycle& cycle = hunt_->cycles()[i];
      if (!missed_by_df(i)) continue;
      if (ne == 1 && cycle.sticking_fraction < 0.02)
        guesses.push_back(guess_from(cycle));
      else
        report_.notes.push_back("harmonic balance was not tried on cycle " + std::to_string(i) +
                                (ne > 1 ? ": it has no describing-function root to begin from"
                                        : ", which sticks: harmonics ripple more than pre-sliding is wide"));
    }
    Effort effort{std::string(balance_name), 0, "evaluations of its equations"};
    for (const HarmonicGuess& guess : guesses) {
      if (stopped()) return;
      const HarmonicBalance found = harmonic_balance(loop_, guess, options);
      effort.count += found.evaluations;
      add_balance(found);
    }
    report_.efforts.push_back(std::move(effort));
    used_.emplace_back(balance_name);
  }

  bool missed_by_df(std::size_t cycle) const {
    return std::ranges::none_of(report_.predictions,
                                [&](const Prediction& p) { return p.method == df_name && p.cycle == cycle; });
  }

  /// The harmonics of a cycle that is known, to see whether the balance has a solution there.
  static HarmonicGuess guess_from(const Cycle& cycle) {
    HarmonicGuess guess{cycle.frequency(), {}, {}, {}};
    guess.inputs.push_back(input_harmonics(cycle, 9));
    return guess;
  }

  void add_balance(const HarmonicBalance& found) {
    if (found.harmonics == 0 || !(found.residual < 1e-6) || !(found.first_harmonic > 0.0)) {
      report_.notes.push_back("harmonic balance found no solution from one of its starts: " + found.why);
      return;
    }
    // Harmonics that still move the answer by more than a verdict allows have not come to one.
    if (found.status != Status::converged && !(found.change < settled)) {
      report_.notes.push_back("harmonic balance came to no prediction from one of its starts: with " +
                              std::to_string(found.harmonics) + " harmonics amplitude and frequency are not settled; " +
                              found.why);
      return;
    }
    Prediction p;
    p.method = balance_name;
    p.amplitude = found.first_harmonic;
    p.frequency = found.frequency;
    p.input_amplitude = std::abs(found.inputs.back()(1));
    p.residual = found.residual;
    p.harmonics = found.harmonics;
    const auto same = [&](const Prediction& q) {
      return q.method == balance_name && std::abs(q.frequency / p.frequency - 1.0) < 1e-6 &&
             std::abs(q.amplitude / p.amplitude - 1.0) < 1e-6;
    };
    if (std::ranges::any_of(report_.predictions, same)) return;
    if (!nearest(hunt_->cycles(), p)) {
      const double late = time_.states() == loop_.states() ? loop_.delay : 0.0;
      const auto states = [&](double phase) { return linear_states(time_, found, phase, late); };
      hunt_->shoot_from(guess_orbit(time_, states, p.frequency, symmetry(time_).has_value()));
    }
    if (const auto cycle = nearest(hunt_->cycles(), p))
      compare(p, hunt_->cycles(), *cycle);
    else
      p.why = "no cycle was found near it";
    if (!found.why.empty()) p.why += "; " + found.why;
    report_.predictions.push_back(std::move(p));
  }

  /// What the approximation of a delay may do to a cycle: the distortion of the delayed signal, harmonic by harmonic.
  double delay_error(const Cycle& cycle) const {
    if (pade_order_ == 0) return 0.0;
    const Eigen::VectorXcd X = input_harmonics(cycle, 199);
    double sum = 0.0;
    for (int n = 1; n < X.size(); ++n)
      sum += std::abs(X(n)) * pade_error(n * cycle.frequency(), loop_.delay, pade_order_);
    return sum / std::abs(X(1));
  }

  void note_memory() {
    for (std::size_t i = 0; i < report_.cycles.size(); ++i) {
      if (report_.cycles[i].remembered == 0) continue;
      report_.notes.push_back(
          "cycle " + std::to_string(i) + " is one of many, close to each other: the law remembers " +
          std::to_string(report_.cycles[i].remembered) + (report_.cycles[i].remembered == 1 ? " number" : " numbers") +
          " of how it got there, which the cycle neither changes nor forgets (their multipliers, 1, "
          "are left out; stability is for a given history)");
    }
  }

  void finish() {
    report_.cycles = hunt_->cycles();
    for (Cycle& cycle : report_.cycles) cycle.error = std::max(cycle.error, delay_error(cycle));
    report_.outcomes = hunt_->outcomes();
    report_.efforts.push_back({"shooting", hunt_->maps(), "return maps"});
    note_memory();
    std::ranges::move(compare_with_interest(report_.cycles, options_.search.has_value(), report_.search),
                      std::back_inserter(report_.notes));
    std::ranges::move(derivative_notes(loop_), std::back_inserter(report_.notes));
    for (const auto& method : used_) {
      const auto missed = missed_by(method, report_.cycles, report_.predictions);
      report_.missed.insert(report_.missed.end(), missed.begin(), missed.end());
    }
    if (stopped()) report_.status = Status::interrupted;
    tell(1.0, "done");
  }

  const Loop& loop_;
  const PredictOptions& options_;
  PredictReport report_;
  SearchBox box_;
  Loop time_;  ///< the same loop as the time domain can treat it
  int pade_order_ = 0;
  std::optional<CycleHunt> hunt_;
  std::optional<LoopBalance> balance_;
  std::optional<CompositeBalance> composite_;
  std::future<DfPredictions> df_search_;
  std::future<CompositeSearch> composite_search_;
  std::map<std::size_t, CompositeRoot> composite_roots_;  ///< by index of the prediction
  std::vector<std::string> used_;
};

}  // namespace

std::vector<double> start_displacements(double unit, const SearchBox& box, int starts) {
  std::vector<double> list;
  double displacement = unit * box.amplitude_max;
  for (int i = 0; i < starts && displacement >= unit * box.amplitude_min; ++i) {
    list.push_back(displacement);
    displacement *= i == 0 ? 0.1 : 0.01;
  }
  return list;
}

PredictReport predict(const Loop& loop, const PredictOptions& options) { return PredictionStudy(loop, options).run(); }

}  // namespace limcycle
