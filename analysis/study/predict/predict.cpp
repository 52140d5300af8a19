#include "limcycle/analysis/study/predict/predict.hpp"

#include <algorithm>
#include <cmath>
#include <future>

#include "limcycle/analysis/derivative_notes.hpp"
#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/steppers/stepper_limits.hpp"
#include "limcycle/analysis/orbit/settle/load_step.hpp"
#include "limcycle/analysis/orbit/settle/stop_map.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/balance/balance_predictions.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/balance/roots/df_predictions.hpp"
#include "limcycle/analysis/study/balance/roots/within_data.hpp"
#include "limcycle/analysis/study/composite/composite_predictions.hpp"
#include "limcycle/analysis/study/predict/between_starts.hpp"
#include "limcycle/analysis/study/predict/cycle_hunt.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"
#include "limcycle/analysis/study/predict/interest.hpp"
#include "limcycle/analysis/study/predict/loop_in_time.hpp"
#include "limcycle/analysis/study/predict/method_names.hpp"
#include "limcycle/analysis/study/predict/prediction_check.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"
#include "limcycle/analysis/study/predict/work_share.hpp"

namespace limcycle {
namespace {

/// The work of one prediction in order of importance: first the outcomes of the loop from every start, then the
/// predictions of the methods within their share of the work, then the verdict on each prediction. Finished parts stay
/// when the user interrupts.
class PredictionStudy {
 public:
  PredictionStudy(const Loop& loop, const PredictOptions& options)
      : loop_(loop), options_(options), box_(options.search.value_or(default_search_box(loop))) {
    report_.search = box_;
  }

  PredictReport run() {
    // If a dead time is approximated, the predictions determine the accuracy required.
    if (!exact_in_time(loop_)) predict_by_df(work_share(0));
    enter_time();
    run_starts();
    if (has_enough()) {
      finish();
      return std::move(report_);
    }
    const WorkShare share = work_share(hunt_->steps());
    const bool wider = widen_box();
    begin_composite(share);
    if (exact_in_time(loop_) || wider) predict_by_df(share);
    end_composite();
    check_predictions(share);
    look_between_starts(share);
    look_beside_unstable_cycles();
    balance_harmonics(share);
    look_beside_unstable_cycles();
    if (loop_.sampled) compare_with_continuous();
    finish();
    return std::move(report_);
  }

 private:
  bool stopped() const { return options_.stop && options_.stop(); }
  bool has_enough() const { return options_.enough && std::ranges::any_of(hunt_->outcomes(), options_.enough); }
  void tell(double fraction, std::string_view what) const {
    if (options_.progress) options_.progress(fraction, what);
  }
  void note(std::string text) { report_.notes.push_back(std::move(text)); }

  void enter_time() {
    double highest = 0.0;
    for (const Prediction& p : report_.predictions) highest = std::max(highest, p.frequency);
    LoopInTime made = loop_in_time(loop_, highest);
    time_ = std::move(made.treated.loop);
    pade_order_ = made.treated.pade_order;
    if (!made.note.empty()) note(std::move(made.note));
    if (time_.continuous) report_.sample_time = sample_time(time_);
    hunt_.emplace(time_, options_, box_);
    if (hunt_->rtol() < SettleOptions{}.rtol)
      note("bristles of this stiffness need a tolerance of " + short_number(hunt_->rtol(), 2) +
           " in simulations (usual is " + short_number(SettleOptions{}.rtol) + "): a looser one breaks stiction early");
  }

  void run_starts() {
    settle_from(start_displacements(output_per_input(time_), box_, options_.starts));
    if (!options_.search && all_diverge() && !stopped()) look_further_down();
    if (!options_.load_step || stopped() || has_enough()) return;
    if (const auto step = load_step(time_)) hunt_->settle_from(step->start, "load step of " + short_number(step->load));
  }

  void settle_from(const std::vector<double>& displacements) {
    double done = 0.0;
    for (const double displacement : displacements) {
      if (stopped() || has_enough()) return;
      tell(0.4 * done++ / static_cast<double>(displacements.size()), "simulation");
      starts_.push_back({displacement, hunt_->outcomes().size()});
      hunt_->settle_from(displaced(time_, displacement), start_name(displacement));
    }
  }

  /// A default box is widened to hold what was found from the starts, so that the methods search there too.
  bool widen_box() {
    if (options_.search) return false;
    auto notes = compare_with_interest(hunt_->cycles(), false, box_);
    std::ranges::move(notes, std::back_inserter(report_.notes));
    report_.search = box_;
    return !notes.empty();
  }

  bool all_diverge() const {
    return !hunt_->outcomes().empty() && std::ranges::all_of(hunt_->outcomes(), [](const OutcomeOfStart& one) {
      return one.outcome == Outcome::divergence;
    });
  }

  /// For a box in which every start diverges: extends it downwards and simulates from smaller displacements.
  void look_further_down() {
    std::vector<double> displacements;
    for (const auto& start : starts_) displacements.push_back(start.place);
    const auto further = extend_down(box_, displacements.back(), options_.starts);
    displacements.insert(displacements.end(), further.begin(), further.end());
    report_.search = box_;
    note("every start in the search box diverges: the box was extended down to an amplitude of " +
         short_number(box_.amplitude_min, 3));
    starts_.clear();
    hunt_.emplace(time_, options_, box_);
    settle_from(displacements);
  }

  /// "y(0) = 0.1", or "y(0) = rest + 0.1" of a loop that does not rest at y = 0.
  std::string start_name(double displacement) const {
    bool exact = false;
    const double rest = time_.output_origin + (time_.C_y * time_.rest_point(exact)).value();
    const bool elsewhere = std::abs(rest) > 1e-9 * std::abs(displacement);
    return (elsewhere ? "y(0) = rest + " : "y(0) = ") + short_number(displacement);
  }

  /// Searches for cycles between the starts.
  void look_between_starts(const WorkShare& share) {
    tell(0.9, "motions between the starts");
    between_.emplace(time_, *hunt_, share.between_steps, options_.stop);
    between_->look_between(starts_, {[&](double displacement) { return displaced(time_, displacement); },
                                     [&](double displacement) { return start_name(displacement); }});
    look_from_stops();
  }

  /// Looks for stable cycles whose range of attraction no start has met, by the map from one stop to the next.
  void look_from_stops() {
    constexpr double near = 1.3;
    constexpr double loose = 1e-5;  // for places to start from; what begins there is simulated as all else
    const double rtol = std::max(hunt_->rtol(), std::min(0.1 * loosest_stiff_tolerance(time_), loose));
    auto map = StopMap::of(time_, rtol, options_.stop);
    if (!map || starts_.empty() || stopped()) return;
    const double most = starts_.front().place;
    for (const double p : map->growing(most * box_.amplitude_min / box_.amplitude_max, most)) {
      const bool known = std::ranges::any_of(hunt_->cycles(), [&](const Cycle& cycle) {
        return cycle.stable == true && cycle.amplitude > p / near && cycle.amplitude < p * near * near;
      });
      if (!known && !stopped()) hunt_->probe_from(map->held_at(p), "held until it breaks away at " + start_name(p));
    }
  }

  void look_beside_unstable_cycles() {
    for (const std::size_t cycle : between_->look_beside_unstable_cycles())
      note("the behaviour just inside and just outside the unstable cycle " + std::to_string(cycle) +
           " was not determined");
  }

  void predict_by_df(const WorkShare& share) {
    if (!options_.methods.describing_function || stopped()) return;
    if (const auto why = FirstHarmonicBalance::not_applicable(loop_)) return note(*why);
    tell(0.6, "roots of 1 + N G");
    forget_df();
    balance_.emplace(loop_);
    DfPredictions found = df_predictions(loop_, *balance_, box_, options_, share.df_evaluations);
    report_.notes.insert(report_.notes.begin(), found.notes.begin(), found.notes.end());
    df_notes_ = std::ssize(found.notes);
    if (found.status != Status::converged) report_.status = found.status;
    if (found.status == Status::incomplete || found.status == Status::not_finite)
      report_.incomplete.emplace_back(df_name);
    report_.predictions = std::move(found.predictions);
    report_.absence = std::move(found.absence);
    report_.describing_function = found.exists;
    report_.efforts.push_back({std::string(df_name), 0, {}});
    (found.status == Status::interrupted ? report_.unfinished : used_).emplace_back(df_name);
  }

  /// Of a search in a smaller box.
  void forget_df() {
    report_.notes.erase(report_.notes.begin(), report_.notes.begin() + std::exchange(df_notes_, 0));
    std::erase(report_.incomplete, df_name);
    std::erase(report_.unfinished, df_name);
    std::erase(used_, df_name);
    std::erase_if(report_.efforts, [](const auto& one) { return one.method == df_name; });
  }

  /// The search with mass and friction as one element runs in parallel to that for roots of 1 + N G: they are
  /// independent.
  void begin_composite(const WorkShare& share) {
    if (!options_.methods.composite || loop_.delay > 0.0 || CompositeBalance::not_applicable(loop_) || stopped())
      return;
    composite_.emplace(loop_);
    composite_search_ = std::async(std::launch::async, [this, most = share.composite_steps] {
      return composite_predictions(*composite_, box_, most, options_.stop);
    });
  }

  void end_composite() {
    if (!composite_search_.valid()) return;
    tell(0.65, "mass and friction as one element");
    CompositePredictions found = composite_search_.get();
    first_composite_ = report_.predictions.size();
    composite_roots_ = std::move(found.roots);
    std::ranges::move(found.predictions, std::back_inserter(report_.predictions));
    std::ranges::move(found.notes, std::back_inserter(report_.notes));
    report_.efforts.push_back(std::move(found.effort));
    if (found.status == Status::incomplete) report_.incomplete.emplace_back(composite_name);
    (found.status == Status::interrupted ? report_.unfinished : used_).emplace_back(composite_name);
  }

  LoopState start_of(std::size_t index) {
    const Prediction& p = report_.predictions[index];
    if (time_.continuous)
      return sampled_state(time_,
                           FirstHarmonicBalance(*time_.continuous).linear_state(p.input_amplitude, p.frequency, 0.0));
    if (p.method == composite_name) return composite_->state(composite_roots_[index - first_composite_]);
    return FirstHarmonicBalance(time_).state(p.input_amplitude, p.frequency);
  }

  /// Verdicts on the predictions: simulates from each predicted oscillation.
  void check_predictions(const WorkShare& share) {
    PredictionCheck check(time_, *hunt_, share.check_steps, options_.stop);
    const std::size_t count = report_.predictions.size();
    for (std::size_t i = 0; i < count && !stopped(); ++i) {
      tell(0.7 + 0.2 * static_cast<double>(i) / static_cast<double>(count), "checking predictions");
      check.check(report_.predictions[i], start_of(i), "prediction " + std::to_string(i));
    }
    if (check.unchecked() > 0)
      note("step limit reached: " + std::to_string(check.unchecked()) +
           " of the predictions were not checked by simulation");
  }

  void balance_harmonics(const WorkShare& share) {
    if (!options_.methods.harmonic_balance || stopped()) return;
    if (time_.continuous) return note("harmonic balance does not treat a sampled controller");
    tell(0.95, "harmonic balance");
    BalancePredictions found = balance_predictions(
        {loop_, time_, balance_ ? &*balance_ : nullptr, report_.predictions, share.balance_evaluations, options_.stop},
        *hunt_);
    std::ranges::move(found.predictions, std::back_inserter(report_.predictions));
    std::ranges::move(found.notes, std::back_inserter(report_.notes));
    if (found.interrupted) return;
    if (found.cut_short) {
      note("harmonic balance: step limit reached, not every start was tried");
      report_.incomplete.emplace_back(balance_name);
    }
    report_.efforts.push_back(std::move(found.effort));
    used_.emplace_back(balance_name);
  }

  /// The same loop with the continuous controller that acts as the sampled one does on average.
  void compare_with_continuous() {
    if (stopped() || starts_.empty()) return;
    Loop averaged = loop_;
    averaged.sampled.reset();
    constexpr int order = 2;  // for the dead time of hold and computation, short against any motion of interest
    const Loop in_time =
        loop_.sampled->delay > 0.0 ? loop_in_time(averaged, 0.0).treated.loop : in_time_domain(averaged, order).loop;
    CycleHunt hunt(in_time, options_, box_);
    std::vector<OutcomeOfStart> all;
    for (const auto& start : starts_) {
      if (stopped()) return;
      all.push_back(hunt.settle_from(displaced(in_time, start.place), start_name(start.place)));
    }
    std::string does;
    const auto add = [&](const std::string& what, const auto& is_one) {
      const auto count = std::ranges::count_if(all, is_one);
      if (count == 0) return;
      does += (does.empty() ? "" : ", ") + what + " from " + std::to_string(count) + " of " +
              std::to_string(all.size()) + " starts";
    };
    for (std::size_t i = 0; i < hunt.cycles().size(); ++i)
      add("comes to a limit cycle of period " + short_number(hunt.cycles()[i].period, 5) + " s",
          [&](const OutcomeOfStart& one) { return one.cycle == i; });
    for (const Outcome outcome : {Outcome::rest, Outcome::sliding, Outcome::irregular, Outcome::family,
                                  Outcome::divergence, Outcome::undecided})
      add(outcome == Outcome::rest ? "comes to rest" : "ends in " + std::string(to_string(outcome)),
          [&](const OutcomeOfStart& one) { return !one.cycle && one.outcome == outcome; });
    note("with the continuous controller that acts on average as this one does, and that dead time, the loop " + does);
  }

  void note_memory() {
    for (std::size_t i = 0; i < report_.cycles.size(); ++i) {
      if (report_.cycles[i].remembered == 0) continue;
      note("cycle " + std::to_string(i) + " is one of a family of neighbouring cycles: the loop keeps " +
           std::to_string(report_.cycles[i].remembered) + (report_.cycles[i].remembered == 1 ? " number" : " numbers") +
           " of its history, which the cycle neither changes nor forgets (their multipliers, 1, are left out; "
           "stability holds for a given history)");
    }
  }

  void note_spreads() {
    const auto percent = [](double share) { return short_number(100.0 * share, 2) + " %"; };
    for (std::size_t i = 0; i < report_.predictions.size(); ++i)
      if (const auto& spread = report_.predictions[i].spread)
        note("prediction " + std::to_string(i) + ": the uncertainty of the data leaves a standard deviation of " +
             percent(spread->amplitude) + " in its amplitude and of " + percent(spread->frequency) +
             " in its frequency");
    for (std::size_t i = 0; i < report_.predictions.size(); ++i)
      if (const auto& band = report_.predictions[i].sampling)
        note("prediction " + std::to_string(i) + ": depending on where its swings meet the samples, its amplitude is " +
             "up to " + percent(band->amplitude) + " and its frequency up to " + percent(band->frequency) +
             " larger or smaller");
  }

  void finish() {
    report_.cycles = hunt_->cycles();
    for (Cycle& cycle : report_.cycles) cycle.error = std::max(cycle.error, delay_error(loop_, pade_order_, cycle));
    report_.outcomes = hunt_->outcomes();
    report_.efforts.push_back({"shooting", hunt_->maps(), "return maps"});
    note_memory();
    std::ranges::move(compare_with_interest(report_.cycles, options_.search.has_value(), report_.search),
                      std::back_inserter(report_.notes));
    std::ranges::move(derivative_notes(loop_), std::back_inserter(report_.notes));
    note_spreads();
    std::ranges::move(data_limits(loop_, box_), std::back_inserter(report_.notes));
    std::ranges::move(measured_notes(loop_), std::back_inserter(report_.notes));
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
  Loop time_;  ///< the same loop for the time domain
  int pade_order_ = 0;
  std::optional<CycleHunt> hunt_;
  std::vector<BetweenStarts::Start> starts_;  ///< displacements of y
  std::optional<BetweenStarts> between_;
  std::optional<FirstHarmonicBalance> balance_;
  std::optional<CompositeBalance> composite_;
  std::future<CompositePredictions> composite_search_;
  std::size_t first_composite_ = 0;  ///< index of its first prediction
  std::vector<CompositeRoot> composite_roots_;
  std::vector<std::string> used_;
  std::ptrdiff_t df_notes_ = 0;  ///< the first of the notes
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
