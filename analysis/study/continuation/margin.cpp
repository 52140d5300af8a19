#include "limcycle/analysis/study/continuation/margin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

#include "limcycle/analysis/derivative_notes.hpp"
#include "limcycle/analysis/on_threads.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/continuation/one_sided_margin.hpp"
#include "limcycle/analysis/study/continuation/outcome_side.hpp"
#include "limcycle/analysis/study/predict/between_starts.hpp"
#include "limcycle/analysis/study/predict/in_exact_time.hpp"
#include "limcycle/analysis/study/predict/loop_in_time.hpp"

namespace limcycle {
namespace {

/// The displacements of predict(), which fall, and behind them those between neighbours.
std::vector<double> with_places_between(const std::vector<double>& places) {
  std::vector<double> all = places;
  for (std::size_t i = 1; i < places.size(); ++i)
    std::ranges::copy(places_between(places[i], places[i - 1]), std::back_inserter(all));
  return all;
}

class Margins {
 public:
  Margins(const Loop& loop, const std::vector<MarginParameter>& parameters, const MarginOptions& options)
      : loop_(loop), parameters_(parameters), options_(options) {
    report_.factor = options.factor;
    report_.notes = derivative_notes(loop);
  }

  MarginReport run() {
    if (!in_exact_time(loop_) && !loop_.sampled) {
      report_.refused = why_not_followed(loop_);
      report_.status = Status::incomplete;
      measure_balance({});
      return std::move(report_);
    }
    PredictOptions predicting = options_.predict;
    predicting.progress = [&](double fraction, std::string_view what) { tell(0.1 * fraction, what); };
    auto found = predict(loop_, predicting);
    box_ = found.search;
    report_.cycles = std::move(found.cycles);
    report_.hunts = std::ranges::any_of(report_.cycles, [](const Cycle& cycle) { return cycle.stable == true; });
    if (loop_.sampled) look_at_outcomes(found.outcomes);
    measure_balance(found.predictions);
    follow_all();
    std::ranges::stable_sort(report_.parameters, {}, &ParameterMargin::distance);
    if (stopped()) report_.status = Status::interrupted;
    return std::move(report_);
  }

 private:
  bool stopped() const { return options_.predict.stop && options_.predict.stop(); }
  void tell(double fraction, std::string_view what) const {
    if (options_.predict.progress) options_.predict.progress(fraction, what);
  }

  void measure_balance(const std::vector<Prediction>& predictions) {
    tell(0.1, "distance from the Nyquist curve");
    const SearchBox box = options_.predict.search.value_or(default_search_box(loop_));
    std::vector<BalanceDistance> roots;
    for (const Prediction& one : predictions)
      if (one.method == "describing-function") roots.push_back({0.0, one.input_amplitude, one.frequency});
    report_.balance = balance_distance(loop_, box, options_.predict.stop, roots);
  }

  /// Of a loop whose cycles cannot be followed: by what it does from the displacements of predict.
  void look_at_outcomes(const std::vector<OutcomeOfStart>& outcomes) {
    const auto places =
        start_displacements(output_per_input(loop_in_time(loop_, 0.0).treated.loop), box_, options_.predict.starts);
    const auto moves = [](const OutcomeOfStart& one) { return one.outcome == Outcome::irregular; };
    report_.hunts = report_.hunts || std::ranges::any_of(outcomes, moves);
    by_outcome_ = OutcomeSide::Starts{with_places_between(places), box_};
    report_.notes.emplace_back(
        "with a sampled controller cycles cannot be followed over a parameter: each side is found by simulations from "
        "the displacements of predict and between them, and by bisection of what they show; near an edge that may "
        "depend on the start");
  }

  MarginSide side_of(const MarginParameter& parameter, bool up, const std::function<void(double)>& progress) const {
    if (by_outcome_)
      return OutcomeSide(parameter, up, options_, *by_outcome_, progress).where_it_changes(report_.hunts);
    OneSidedMargin side(parameter, up, options_, progress);
    return report_.hunts ? side.where_hunting_ends(report_.cycles) : side.where_hunting_begins();
  }

  /// Both sides of every parameter; those that were not finished are not kept.
  void follow_all() {
    std::vector<std::array<std::optional<MarginSide>, 2>> sides(parameters_.size());
    const auto follow = [&](std::size_t task, const std::function<void(double)>& progress) {
      if (stopped()) return;
      progress(0.0);
      MarginParameter parameter = parameters_[task / 2];
      if (!by_outcome_) parameter.family = in_exact_time(std::move(parameter.family));
      MarginSide side = side_of(parameter, task % 2 == 0, progress);
      if (!stopped()) sides[task / 2][task % 2] = std::move(side);
    };
    share_tasks(options_.threads, 2 * parameters_.size(), follow,
                [&](double share, std::size_t task) { tell(0.15 + 0.85 * share, parameters_[task / 2].path); });
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const auto& [up, down] = sides[i];
      for (const auto* side : {&up, &down})
        if (*side && (*side)->what == MarginSide::What::unknown) report_.status = Status::incomplete;
      if (up && down) report_.parameters.push_back({parameters_[i], *up, *down});
    }
  }

  const Loop& loop_;
  const std::vector<MarginParameter>& parameters_;
  const MarginOptions& options_;
  MarginReport report_;
  SearchBox box_{};
  std::optional<OutcomeSide::Starts> by_outcome_ = {};  ///< present if cycles cannot be followed
};

}  // namespace

std::string_view to_string(MarginSide::What what) {
  switch (what) {
    case MarginSide::What::ends:
      return "ends";
    case MarginSide::What::begins:
      return "begins";
    case MarginSide::What::none:
      return "none";
    default:
      return "unknown";
  }
}

const MarginSide* ParameterMargin::nearest() const {
  if (!up.found() && !down.found()) return nullptr;
  if (!up.found() || !down.found()) return up.found() ? &up : &down;
  const auto far = [&](const MarginSide& side) { return std::abs(side.value - parameter.value); };
  return far(up) <= far(down) ? &up : &down;
}

double ParameterMargin::distance() const {
  const MarginSide* side = nearest();
  return side ? std::abs(side->value / parameter.value - 1.0) : infinite;
}

MarginReport margin(const Loop& loop, const std::vector<MarginParameter>& parameters, const MarginOptions& options) {
  return Margins(loop, parameters, options).run();
}

}  // namespace limcycle
