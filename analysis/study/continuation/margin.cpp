#include "limcycle/analysis/study/continuation/margin.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "limcycle/analysis/derivative_notes.hpp"
#include "limcycle/analysis/study/continuation/margin_side.hpp"
#include "limcycle/analysis/study/predict/in_exact_time.hpp"

namespace limcycle {
namespace {

class Margins {
 public:
  Margins(const Loop& loop, const std::vector<MarginParameter>& parameters, const MarginOptions& options)
      : loop_(loop), parameters_(parameters), options_(options) {
    report_.factor = options.factor;
    report_.notes = derivative_notes(loop);
  }

  MarginReport run() {
    if (!in_exact_time(loop_)) {
      report_.refused = why_not_followed(loop_);
      report_.status = Status::incomplete;
      measure_balance();
      return std::move(report_);
    }
    PredictOptions predicting = options_.predict;
    predicting.progress = [&](double fraction, std::string_view what) { tell(0.1 * fraction, what); };
    auto found = predict(loop_, predicting);
    box_ = found.search;
    report_.cycles = std::move(found.cycles);
    report_.hunts = std::ranges::any_of(report_.cycles, [](const Cycle& cycle) { return cycle.stable == true; });
    measure_balance();
    for (std::size_t i = 0; i < parameters_.size() && !stopped(); ++i) one(i);
    std::ranges::stable_sort(report_.parameters, {}, &ParameterMargin::distance);
    if (stopped()) report_.status = Status::interrupted;
    return std::move(report_);
  }

 private:
  bool stopped() const { return options_.predict.stop && options_.predict.stop(); }
  void tell(double fraction, std::string_view what) const {
    if (options_.predict.progress) options_.predict.progress(fraction, what);
  }

  void measure_balance() {
    tell(0.1, "distance from the Nyquist curve");
    const SearchBox box = options_.predict.search.value_or(default_search_box(loop_));
    report_.balance = balance_distance(loop_, box, options_.predict.stop);
  }

  void one(std::size_t index) {
    ParameterMargin result{parameters_[index], {}, {}};
    result.parameter.family = in_exact_time(std::move(result.parameter.family));
    const double each = 0.85 / static_cast<double>(parameters_.size());
    for (const bool up : {true, false}) {
      const double begin = 0.15 + each * (static_cast<double>(index) + (up ? 0.0 : 0.5));
      tell(begin, result.parameter.path);
      SideSearch side(result.parameter, up, options_,
                      [&](double share) { tell(begin + 0.5 * each * share, result.parameter.path); });
      MarginSide& target = up ? result.up : result.down;
      target = report_.hunts ? side.where_hunting_ends(report_.cycles) : side.where_hunting_begins();
      if (stopped()) return;  // incomplete: not kept
      if (target.what == MarginSide::What::unknown && report_.status == Status::converged)
        report_.status = Status::incomplete;
    }
    report_.parameters.push_back(std::move(result));
  }

  const Loop& loop_;
  const std::vector<MarginParameter>& parameters_;
  const MarginOptions& options_;
  MarginReport report_;
  SearchBox box_{};
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
