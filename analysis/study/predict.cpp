#include "limcycle/analysis/study/predict.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "limcycle/analysis/orbit/edge.hpp"
#include "limcycle/analysis/orbit/measure.hpp"
#include "limcycle/analysis/study/loop_balance.hpp"
#include "limcycle/analysis/study/verdicts.hpp"

namespace limcycle {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// The work of one prediction, step by step, so that what is finished stays when the user interrupts.
class Study {
 public:
  Study(const Loop& loop, const PredictOptions& options) : loop_(loop), options_(options) {
    report_.search = options.search.value_or(default_search_box(loop));
    settle_.amplitude_floor = report_.search.amplitude_min;
    settle_.amplitude_ceiling = 1e4 * report_.search.amplitude_max;
    settle_.shooting.rtol = std::clamp(3e-4 * options.accuracy, 1e-13, 1e-9);
    settle_.shooting.tolerance = 30.0 * settle_.shooting.rtol;
    settle_.stop = settle_.shooting.stop = options.stop;
  }

  PredictReport run() {
    find_roots_of_balance();
    if (loop_.delay > 0.0) {
      report_.notes.emplace_back(
          "delay: the frequency domain is exact, but the time domain does not treat a delay yet, so nothing was "
          "checked");
      for (auto& p : report_.predictions) p.why = "not checked: the time domain does not treat a delay yet";
      report_.status = Status::incomplete;
      return std::move(report_);
    }
    run_starts();
    for (std::size_t i = 0; i < report_.predictions.size() && !stopped(); ++i) check(report_.predictions[i], i);
    if (!LoopBalance::not_applicable(loop_))
      report_.missed = missed_by("describing-function", report_.cycles, report_.predictions);
    if (stopped()) report_.status = Status::interrupted;
    tell(1.0, "done");
    return std::move(report_);
  }

 private:
  bool stopped() const { return options_.stop && options_.stop(); }
  void tell(double fraction, std::string_view what) const {
    if (options_.progress) options_.progress(fraction, what);
  }

  void find_roots_of_balance() {
    tell(0.0, "roots of 1 + N G");
    if (const auto why = LoopBalance::not_applicable(loop_)) {
      report_.notes.push_back(*why);
      return;
    }
    const LoopBalance balance(loop_);
    for (const double pole : undamped_poles())
      report_.notes.push_back("the rest of the loop has an undamped resonance at " + number(pole) +
                              " rad/s: roots within 0.1 % of it are not looked for");
    for (const SearchBox& box : between_undamped_poles()) {
      const auto found = search(balance, box);
      for (const Root& root : found.roots) add(balance, root);
    }
    report_.nyquist = nyquist_picture(loop_, report_.search);
  }

  std::vector<double> undamped_poles() const {
    std::vector<double> found;
    for (const auto& pole : loop_.A.eigenvalues())
      if (pole.imag() > 0.0 && std::abs(pole.real()) < 1e-9 * pole.imag()) found.push_back(pole.imag());
    std::ranges::sort(found);
    return found;
  }

  /// G is infinite at an undamped pole of the rest of the loop: the box is cut there, a part in 1e3 of the frequency.
  std::vector<SearchBox> between_undamped_poles() const {
    const auto cuts = undamped_poles();
    std::vector<SearchBox> boxes{report_.search};
    for (const double cut : cuts) {
      SearchBox& last = boxes.back();
      if (cut <= last.frequency_min * 1.001 || cut >= last.frequency_max * 0.999) continue;
      SearchBox next = last;
      last.frequency_max = cut * (1.0 - 1e-3);
      next.frequency_min = cut * (1.0 + 1e-3);
      boxes.push_back(next);
    }
    return boxes;
  }

  /// On a belt N has a kink where the velocity amplitude A w is the mean velocity: there the search runs over (A w, w),
  /// in which that line is straight.
  RootSearch search(const LoopBalance& balance, SearchBox box) {
    RootSearchOptions options;
    options.interrupted = options_.stop;
    if (balance.main_element() > 0) options.max_evaluations = 20000;  // the other element's kink crosses the whole box
    for (const auto& pole : loop_.A.eigenvalues())
      if (pole.imag() > box.frequency_min && pole.imag() < box.frequency_max)
        options.frequency_hints.push_back(std::abs(pole));
    // The phase of a delay must not turn by more than about 0.7 between two samples.
    const double turns = box.frequency_max * loop_.delay * std::log(box.frequency_max / box.frequency_min);
    options.initial_cells_frequency = std::clamp(static_cast<int>(turns / 1.4), options.initial_cells_frequency, 800);
    const double speed = std::abs(balance.mean_velocity());
    if (speed > 0.0) {
      box.amplitude_min *= box.frequency_min;
      box.amplitude_max *= box.frequency_max;
      if (speed > box.amplitude_min && speed < box.amplitude_max) options.amplitude_hints = {speed};
    }
    auto found =
        find_roots([&](double A, double w, double accuracy) { return balance(speed > 0.0 ? A / w : A, w, accuracy); },
                   box, options);
    if (speed > 0.0) {
      for (Root& root : found.roots) root.amplitude /= root.frequency;
      std::erase_if(found.roots, [&](const Root& root) {
        return root.amplitude < report_.search.amplitude_min || root.amplitude > report_.search.amplitude_max;
      });
    }
    if (found.status != Status::converged && found.status != Status::no_cycle) {
      report_.notes.push_back("the root search between " + number(box.frequency_min) + " and " +
                              number(box.frequency_max) + " rad/s ended with status " +
                              std::string(to_string(found.status)) + ": roots may be missing");
      report_.status = found.status == Status::not_finite ? Status::not_finite : Status::incomplete;
    }
    return found;
  }

  void add(const LoopBalance& balance, const Root& root) {
    Prediction p;
    p.input_amplitude = root.amplitude;
    p.amplitude = balance.output_amplitude(root.amplitude, root.frequency);
    p.frequency = root.frequency;
    p.residual = std::abs(balance(root.amplitude, root.frequency, 1e-12));
    p.stable = balance.stable(root.amplitude, root.frequency, root.index);
    report_.predictions.push_back(p);
  }

  /// Initial displacements of y: the largest amplitude of interest and smaller ones, two and then one decade apart.
  void run_starts() {
    double displacement = report_.search.amplitude_max;
    for (int i = 0; i < options_.starts && !stopped(); ++i, displacement *= i == 1 ? 0.1 : 0.01) {
      tell(0.2 + 0.5 * i / std::max(1, options_.starts), "simulation");
      if (displacement < report_.search.amplitude_min) break;
      settle_from(displaced(loop_, displacement), "y displaced by " + number(displacement));
    }
  }

  const OutcomeOfStart& settle_from(const LoopState& start, std::string name) {
    settle_.known = report_.cycles;
    Settled settled = settle(loop_, start, settle_);
    OutcomeOfStart outcome{std::move(name), settled.outcome, std::move(settled.why), {}, std::move(settled.trace)};
    outcome.cycle = settled.known;
    if (settled.shot) outcome.cycle = merge(report_.cycles, settled.shot->cycle);
    report_.outcomes.push_back(std::move(outcome));
    return report_.outcomes.back();
  }

  /// What a prediction is worth: go to the predicted oscillation and see what the loop does there.
  void check(Prediction& p, std::size_t index) {
    tell(0.7 + 0.3 * static_cast<double>(index) / static_cast<double>(report_.predictions.size()),
         "checking predictions");
    const LoopState start = LoopBalance(loop_).state(p.input_amplitude, p.frequency);
    if (p.stable != true && unstable_cycle_near(p)) return;
    const auto& outcome = settle_from(start, "the oscillation predicted by root " + std::to_string(index));
    if (outcome.cycle && p.stable == true) {
      // What a stable prediction leads to is what it is about, unless it is absurdly far from it.
      if (nearest({report_.cycles[*outcome.cycle]}, p)) return compare(p, report_.cycles, *outcome.cycle);
    }
    if (const auto cycle = nearest(report_.cycles, p); cycle && report_.cycles[*cycle].stable == p.stable)
      return compare(p, report_.cycles, *cycle);
    const bool decided = outcome.outcome != Outcome::undecided;
    if (p.stable == true && decided) {
      p.verdict = Verdict::wrong;
      p.why = "no such cycle: a motion started on it ends in " + std::string(to_string(outcome.outcome));
    } else {
      p.why = p.stable == true ? "the simulation from it was not decided"
                               : "no unstable cycle was found near it, none was excluded";
    }
  }

  /// Newton on the return map from the predicted oscillation itself, without letting the motion run away first; if that
  /// ends elsewhere, the border between what larger and smaller oscillations lead to.
  bool unstable_cycle_near(Prediction& p) {
    const LoopBalance balance(loop_);
    const bool odd = symmetry(loop_).has_value();
    ShootingOptions options = settle_.shooting;
    options.warm_maps = 0;
    options.max_maps = 60;
    const auto accept = [&](const ShootingResult& shot) {
      if (shot.status != Status::converged || shot.cycle.stable != false || !nearest({shot.cycle}, p)) return false;
      compare(p, report_.cycles, merge(report_.cycles, shot.cycle));
      return true;
    };
    const double period = 6.283185307179586 / p.frequency;
    const auto ray = [&](double scale) { return balance.state(p.input_amplitude, p.frequency, scale); };
    for (const double scale : {1.0, 0.9, 1.1}) {
      Trace trace;
      if (stopped() || record(loop_, ray(scale), period, 1e-8, 200, trace) != Status::converged) continue;
      if (accept(shoot(loop_, ray(scale), choose_section(loop_, trace), odd, options))) return true;
    }
    settle_.known = report_.cycles;
    return !stopped() && accept(edge_cycle(loop_, ray, period, settle_));
  }

  const Loop& loop_;
  const PredictOptions& options_;
  SettleOptions settle_;
  PredictReport report_;
};

}  // namespace

PredictReport predict(const Loop& loop, const PredictOptions& options) { return Study(loop, options).run(); }

}  // namespace limcycle
