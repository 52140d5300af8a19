#include "limcycle/analysis/study/tune/tune.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/remedy/linear_costs.hpp"
#include "limcycle/analysis/study/tune/judged_points.hpp"
#include "limcycle/analysis/study/tune/local_search.hpp"
#include "limcycle/analysis/study/tune/squared_error.hpp"
#include "limcycle/analysis/sweep.hpp"

namespace limcycle {
namespace {

constexpr std::size_t most_searches = 3, judged_at_once = 4;
constexpr double starts_apart = 0.2;  ///< of two starts of local searches, in shares of the box
constexpr double same_cost_by = 0.01, same_place_by = 0.05, near_cost_by = 0.05;
constexpr int most_results = 5;  ///< that are confirmed one after another, each better than the one before
/// Where the parts of the progress bar begin: design, starts, searches, confirmation.
constexpr double stage_ends[] = {0.05, 0.2, 0.4, 0.9, 1.0};

class TuneStudy {
 public:
  TuneStudy(const LoopParts& parts, const std::vector<TuneNumber>& numbers, const LoopWith& loop_with,
            const TuneOptions& options)
      : parts_(parts), options_(options), space_(numbers) {
    report_.numbers = numbers;
    report_.minimised = question_.minimised = options.minimised;
    report_.limits = question_.limits = options.limits;
    report_.horizon = question_.horizon = options.horizon;
    question_.loop_with = loop_with;
    report_.margin = options.margin;
    report_.aside += options.margin;
    if (options.margin > 0.0)
      question_.margin = [this](std::span<const double> values) { return space_.beside(values, options_.margin, 0.0); };
  }

  TuneReport run() {
    look_at_the_loop();
    look_at_design();
    search_from_all(find_starts());
    settle_on_best();
    compare_searches();
    finish();
    return std::move(report_);
  }

 private:
  bool stopped() const { return options_.predict.stop && options_.predict.stop(); }
  void tell(double fraction, std::string_view what) const {
    if (options_.predict.progress) options_.predict.progress(fraction, what);
  }
  SweepOptions part(std::size_t number, const std::string& what) const {
    return part_of_work(options_.threads, options_.predict.stop, options_.predict.progress, stage_ends[number],
                        stage_ends[number + 1], what);
  }
  std::optional<double> cost(std::size_t point) const { return question_.cost_of(report_.points[point]); }

  void look_at_the_loop() {
    tell(0.0, "the loop as it stands");
    const Loop loop = build_loop(parts_);
    HuntsAnswer answer = hunts(loop, {options_.predict});
    report_.hunts = answer.hunts;
    report_.why = std::move(answer.why);
    Judging& judging = question_.judging;
    judging = judging_of_variants(options_.predict, answer.found);
    std::size_t starts = 0;
    for (const OutcomeOfStart& one : answer.found.outcomes) starts += one.probe ? 0 : 1;
    if (judging.may_diverge.size() == starts) judging.may_diverge.clear();  // a loop that only diverges excuses nothing
    if (!answer.found.outcomes.empty()) report_.before = std::move(answer.found.outcomes.front().trace);
    question_.step = start_displacements(output_per_input(loop), answer.found.search, 1).front();
    report_.step = question_.step;
    report_.now = loop_costs(parts_, report_.step, report_.before, report_.hunts == Hunts::no);
    question_.linear = linear_costs(parts_, 0.0).why_not.empty();
    if (options_.minimised == TuneCost::ise) {
      if (const auto found = squared_error_of(parts_, question_)) report_.cost_now = found->value;
    } else {
      report_.cost_now = options_.minimised == TuneCost::ms ? report_.now.peak_sensitivity : report_.now.settling_time;
    }
  }

  void look_at_design() {
    std::vector<double> own;
    for (const TuneNumber& one : report_.numbers) own.push_back(one.own);
    if (space_.contains(own)) add(space_.values(space_.place(own)), TunePoint::Part::own);
    for (const auto& place : space_.design(options_.samples, options_.seed))
      add(space_.values(place), TunePoint::Part::design);
    run_each(
        report_.points.size(), [&](std::size_t i) { look_at(report_.points[i], question_); },
        part(0, "points of the design"));
  }

  void add(std::vector<double> values, TunePoint::Part from) {
    const bool known = std::ranges::any_of(report_.points, [&](const TunePoint& one) { return one.values == values; });
    if (!known) report_.points.push_back({std::move(values), from});
  }

  /// Points that may still be judged, the cheapest first.
  std::vector<std::size_t> open_points() const {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < report_.points.size(); ++i)
      if (report_.points[i].outcome == TuneOutcome::not_judged && cost(i)) open.push_back(i);
    std::ranges::stable_sort(open, {}, [&](std::size_t i) { return *cost(i); });
    return open;
  }

  /// Judges points in the order of cost until enough of them that lie apart do not hunt: the starts of the searches.
  std::vector<std::size_t> find_starts() {
    std::vector<std::size_t> starts;
    const auto is_apart = [&](std::size_t i) {
      const auto place = space_.place(report_.points[i].values);
      return std::ranges::all_of(starts, [&](std::size_t k) {
        return distance_between(place, space_.place(report_.points[k].values)) > starts_apart;
      });
    };
    const auto open = open_points();
    for (std::size_t next = 0; next < open.size() && starts.size() < most_searches && !stopped();) {
      std::vector<std::size_t> batch;  // of a size of its own, so that threads do not matter
      for (; next < open.size() && batch.size() < judged_at_once; ++next)
        if (is_apart(open[next])) batch.push_back(open[next]);
      tell(stage_ends[1] +
               (stage_ends[2] - stage_ends[1]) * 0.3 * static_cast<double>(next) / static_cast<double>(open.size()),
           "does it hunt");
      const JudgedPoints judged = judged_points();
      const auto judge_one = [&](std::size_t i) {
        TunePoint& point = report_.points[batch[i]];
        judge(point, question_, judged.hunting_near(point.values));
      };
      run_each(batch.size(), judge_one, {options_.threads, options_.predict.stop, {}});
      for (const std::size_t i : batch)
        if (report_.points[i].outcome == TuneOutcome::feasible && starts.size() < most_searches && is_apart(i))
          starts.push_back(i);
    }
    return starts;
  }

  void search_from_all(const std::vector<std::size_t>& starts) {
    std::vector<LocalSearch> all(starts.size());
    run_each(
        starts.size(),
        [&](std::size_t i) { all[i] = search_from(report_.points, starts[i], i, space_, question_, options_.seed); },
        part(2, "local searches"));
    for (std::size_t i = 0; i < all.size(); ++i) {
      LocalSearch& one = all[i];
      const std::size_t to = one.reached ? report_.points.size() + *one.reached : starts[i];
      report_.searches.push_back({starts[i], to, one.judged, one.ended});
      std::ranges::move(one.points, std::back_inserter(report_.points));
    }
  }

  /// The feasible point with the least cost, to what four digits show: of several the first.
  std::optional<std::size_t> best_point() const {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < report_.points.size(); ++i)
      if (report_.points[i].outcome == TuneOutcome::feasible && cost(i) && (!best || is_lower(*cost(i), *cost(*best))))
        best = i;
    return best;
  }

  JudgedPoints judged_points() const {
    JudgedPoints judged(space_);
    for (const TunePoint& one : report_.points) judged.add(one);
    return judged;
  }

  /// The result: the best point that stands a second judgement, with the motions of its own surroundings. What they
  /// show to be better is tried in its turn.
  void settle_on_best() {
    tell(stage_ends[3], "confirmation");
    int better = 0;
    while ((report_.best = best_point()) && !stopped()) {
      const std::size_t best = *report_.best;
      if (!stands_by_itself(report_.points[best])) continue;
      look_around();
      if (!stands_by_itself(report_.points[best])) continue;
      if (question_.margin || best_point() == best || ++better > most_results) break;
    }
    if (!report_.best) return;
    const auto parts = question_.loop_with(report_.points[*report_.best].values);
    if (stopped()) {
      report_.costs = loop_costs(*parts, report_.step, {}, false);
      report_.notes.emplace_back("the result was not judged a second time, since the work was interrupted");
      return;
    }
    report_.after = run_from_step(*parts, question_).trace;
    report_.costs = loop_costs(*parts, report_.step, report_.after, true);
    if (report_.minimised != TuneCost::ise) return;
    if (const auto found = squared_error_of(*parts, question_)) report_.cost_error = found->error;
  }

  /// Judges a feasible point once more: from the starts of its own search box, as predict() would by itself, and from
  /// the hunting motions that are known by now.
  bool stands_by_itself(TunePoint& point) {
    TuneQuestion by_itself = question_;
    if (!options_.predict.search)
      by_itself.judging.predict.search = default_search_box(build_loop(*question_.loop_with(point.values)));
    TunePoint again{point.values, point.part, point.search};
    judge(again, by_itself, judged_points().hunting_near(point.values));
    const bool as_before = again.outcome == TuneOutcome::diverges && !question_.judging.may_diverge.empty();
    if (again.outcome == TuneOutcome::feasible || as_before || again.outcome == TuneOutcome::not_judged) return true;
    point.outcome = again.outcome;
    point.why = again.why;
    point.hunting = again.hunting;
    return false;
  }

  /// What a small change of each number does.
  void look_around() {
    const std::vector<double> values = report_.points[*report_.best].values;
    std::vector<TunePoint> around;
    for (auto& other : space_.beside(values, report_.aside, 0.01))
      around.push_back({std::move(other), TunePoint::Part::neighbour});
    TuneQuestion alone = question_;
    alone.margin = {};
    const JudgedPoints judged = judged_points();
    const auto judge_one = [&](std::size_t k) {
      TunePoint& point = around[k];
      if (point.values.empty()) return;
      look_at(point, alone);
      if (point.outcome == TuneOutcome::not_judged && alone.cost_of(point))
        judge(point, alone, judged.hunting_near(point.values));
    };
    run_each(around.size(), judge_one, {options_.threads, options_.predict.stop, {}});
    report_.surroundings.assign(values.size(), {});
    for (std::size_t k = 0; k < around.size(); ++k) {
      if (around[k].outcome == TuneOutcome::not_judged) continue;
      auto& side = report_.surroundings[k / 2];
      (k % 2 == 0 ? side.below : side.above) = around[k].outcome;
      report_.points.push_back(std::move(around[k]));
    }
  }

  /// Compares the ends of the searches that converged with the result.
  void compare_searches() {
    if (!report_.best) return;
    std::vector<std::size_t> ends;
    for (const TuneSearch& one : report_.searches)
      if (one.ended && report_.points[one.to].outcome == TuneOutcome::feasible) ends.push_back(one.to);
    if (ends.empty()) return;
    report_.agreement = ends.size() == 1 ? TuneAgreement::single : TuneAgreement::same_point;
    const auto place = space_.place(report_.points[*report_.best].values);
    const double least = *cost(*report_.best);
    for (const std::size_t end : ends) {
      const bool here = distance_between(place, space_.place(report_.points[end].values)) <= same_place_by;
      if (*cost(end) > least + (here ? near_cost_by : same_cost_by) * std::abs(least)) {
        report_.agreement = TuneAgreement::local_optima;
        return;
      }
      if (ends.size() > 1 && !here) report_.agreement = TuneAgreement::same_cost;
    }
  }

  void finish() {
    const auto count = [&](TuneOutcome outcome) {
      return std::ranges::count(report_.points, outcome, [](const TunePoint& one) { return one.outcome; });
    };
    if (stopped())
      report_.status = Status::interrupted;
    else if (!report_.best && count(TuneOutcome::undecided) > 0)
      report_.status = Status::incomplete;
    if (!question_.judging.may_diverge.empty())
      report_.notes.emplace_back(
          "starts from which the loop diverges as it stands may diverge: they are no reason against a point");
  }

  const LoopParts& parts_;
  const TuneOptions& options_;
  const TuneSpace space_;
  TuneQuestion question_;
  TuneReport report_;
};

}  // namespace

std::string_view to_string(TuneAgreement agreement) {
  switch (agreement) {
    case TuneAgreement::single:
      return "single";
    case TuneAgreement::same_point:
      return "same-point";
    case TuneAgreement::same_cost:
      return "same-cost";
    case TuneAgreement::local_optima:
      return "local-optima";
    case TuneAgreement::none:
      break;
  }
  return "none";
}

TuneReport tune(const LoopParts& parts, const std::vector<TuneNumber>& numbers, const LoopWith& loop_with,
                const TuneOptions& options) {
  if (numbers.empty()) throw std::invalid_argument("a number that may be chosen is needed");
  for (const TuneNumber& one : numbers)
    if (!(one.low < one.high) || !std::isfinite(one.low) || !std::isfinite(one.high))
      throw std::invalid_argument("the bounds of " + one.path + " are out of order");
  return TuneStudy(parts, numbers, loop_with, options).run();
}

}  // namespace limcycle
