#include "limcycle/analysis/study/precision/precision.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/sweep.hpp"
#include "limcycle/models/delay.hpp"

namespace limcycle {
namespace {

/// The loop for the time domain: a delay that is not exact there is approximated to 1e-9 up to 40 rad over the delay at
/// most.
TimeDomainLoop treat_in_time(const Loop& loop, std::vector<std::string>& notes) {
  if (loop.delay == 0.0) return {loop, 0, 0};
  int order = lowest_pade_order;
  while (order < highest_pade_order && pade_error(20.0 / loop.delay, loop.delay, order) > 1e-9) ++order;
  auto treated = in_time_domain(loop, order);
  if (treated.pade_order > 0)
    notes.push_back("the reference and all simulations have the delay as a Pade approximation of order " +
                    std::to_string(order) + "; the describing function and harmonic balance have it exactly");
  return treated;
}

/// Tasks that do not depend on each other, each with results of its own, so that the report is in the same order for
/// any number of threads.
class PrecisionStudy {
 public:
  explicit PrecisionStudy(const PrecisionOptions& options) : options_(options) {}

  void ask_cycle(const LoopParts& parts) {
    loop_.emplace(build_loop(parts));
    time_.emplace(treat_in_time(*loop_, report_.notes));
    if (options_.progress) options_.progress(0.0, "reference cycle");
    WorkChart& chart = report_.cycle_chart.emplace();
    chart.question = "cycle";
    report_.cycle = cycle_reference(time_->loop, options_.cycle.predict, options_.cycle.check_steps, chart.why);
    if (stopped()) chart.why = "interrupted";
    if (!report_.cycle) return;
    const CycleReference& reference = *report_.cycle;
    chart.answered = reference.verified();
    chart.made_by = reference.made_by;
    chart.verified_by = reference.verified_by;
    chart.agreement = reference.agreement;
    chart.floor = reference.error;
    if (!chart.answered) return;
    methods_ = stepper_methods(time_->loop, reference, options_.cycle);
    methods_.push_back(shooting_method(time_->loop, reference, options_.cycle));
    methods_.push_back(balance_method(*loop_, reference, options_.cycle));
    std::ranges::move(first_harmonic_methods(*loop_, reference, options_.cycle), std::back_inserter(methods_));
    std::ranges::copy(options_.more, std::back_inserter(methods_));
    results_.resize(methods_.size());
    for (std::size_t i = 0; i < methods_.size(); ++i)
      tasks_.emplace_back([this, i] { results_[i] = run_method(methods_[i], options_.work); });
  }

  void ask_describing_function(const Element& element, const std::vector<DfPoint>& points) {
    tasks_.emplace_back([this, &element, &points] {
      DfPrecisionOptions own = options_.df;
      own.work = options_.work;
      df_ = df_precision(element, points, own);
    });
  }

  void ask_stiffness(const LoopParts& parts) {
    ladder_ = stiffness_ladder(parts);
    if (ladder_.empty() || ladder_.front().loop.delay > 0.0) return;
    stiffness_.resize(ladder_.size());
    for (std::size_t i = 0; i < ladder_.size(); ++i) tasks_.emplace_back([this, i] { run_stiffness(i); });
  }

  PrecisionReport run() {
    run_each(
        tasks_.size(), [&](std::size_t i) { tasks_[i](); },
        part_of_work(options_.threads, options_.work.stop, options_.progress, 0.05, 1.0, "methods"));
    if (report_.cycle_chart) {
      for (auto& points : results_) std::ranges::move(points, std::back_inserter(report_.cycle_chart->points));
      conclude(*report_.cycle_chart);
    }
    if (df_) chart_describing_function();
    for (auto& one : stiffness_) {
      std::ranges::move(one.points, std::back_inserter(report_.stiffness.points));
      std::ranges::move(one.notes, std::back_inserter(report_.stiffness.notes));
    }
    if (stopped()) report_.status = Status::interrupted;
    return std::move(report_);
  }

 private:
  bool stopped() const { return options_.work.stop && options_.work.stop(); }

  void run_stiffness(std::size_t rung) {
    CycleMethodsOptions own = options_.cycle;
    own.tolerances = options_.stiff_tolerances;
    own.periods = options_.stiff_periods;
    own.max_steps = options_.stiff_max_steps;
    WorkOptions work = options_.work;
    work.repeats = 1;
    stiffness_[rung] = stiffness_study({ladder_[rung]}, own, work, report_.cycle);
  }

  void chart_describing_function() {
    DfPrecision& found = *df_;
    WorkChart& chart = report_.df_chart.emplace();
    chart.question = "describing-function";
    chart.answered = !found.points.empty() && found.verified();
    chart.made_by = found.made_by;
    chart.verified_by = found.verified_by;
    chart.agreement = found.agreement;
    chart.floor = std::max(found.error, 1e-15);
    if (found.points.empty()) chart.why = "the element has no describing function at any of the points";
    if (!found.points.empty() && !found.verified())
      chart.why =
          "the " + found.made_by + " and the " + found.verified_by + " differ by " + short_number(found.agreement);
    if (chart.answered) chart.points = std::move(found.results);
    report_.notes.insert(report_.notes.end(), found.notes.begin(), found.notes.end());
    report_.df_points = std::move(found.points);
    conclude(chart);
  }

  const PrecisionOptions& options_;
  std::optional<Loop> loop_;  // these two outlive the methods
  std::optional<TimeDomainLoop> time_;
  std::vector<WorkMethod> methods_;              ///< for the cycle
  std::vector<std::vector<WorkPoint>> results_;  ///< of each of them
  std::optional<DfPrecision> df_;
  std::vector<StiffLoop> ladder_;
  std::vector<StiffnessStudy> stiffness_;  ///< of each of its rungs
  std::vector<std::function<void()>> tasks_;
  PrecisionReport report_;
};

}  // namespace

void conclude(WorkChart& chart) {
  chart.front = pareto_front(chart.points, std::isfinite(chart.floor) ? chart.floor : 0.0);
  chart.methods.clear();
  chart.never_best.clear();
  for (const auto& point : chart.points)
    if (std::ranges::find(chart.methods, point.method) == chart.methods.end()) chart.methods.push_back(point.method);
  for (const auto& method : chart.methods)
    if (std::ranges::none_of(chart.front, [&](std::size_t i) { return chart.points[i].method == method; }))
      chart.never_best.push_back(method);
}

PrecisionReport precision(const LoopParts* parts, const Element* element, const std::vector<DfPoint>& points,
                          const PrecisionOptions& options) {
  PrecisionStudy study(options);
  if (parts != nullptr) study.ask_cycle(*parts);
  if (element != nullptr) study.ask_describing_function(*element, points);
  if (parts != nullptr && options.stiffness) study.ask_stiffness(*parts);
  return study.run();
}

}  // namespace limcycle
