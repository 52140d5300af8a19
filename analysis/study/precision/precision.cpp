#include "limcycle/analysis/study/precision/precision.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
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

class PrecisionStudy {
 public:
  PrecisionStudy(const PrecisionOptions& options) : options_(options) {}

  void ask_cycle(const LoopParts& parts) {
    const Loop loop = build_loop(parts);
    const TimeDomainLoop time = treat_in_time(loop, report_.notes);
    tell(0.0, "reference cycle");
    WorkChart chart;
    chart.question = "cycle";
    report_.cycle = cycle_reference(time.loop, options_.cycle.predict, options_.cycle.check_steps, chart.why);
    if (stopped()) chart.why = "interrupted";
    if (report_.cycle) {
      const CycleReference& reference = *report_.cycle;
      chart.answered = reference.verified();
      chart.made_by = reference.made_by;
      chart.verified_by = reference.verified_by;
      chart.agreement = reference.agreement;
      chart.floor = reference.error;
    }
    if (chart.answered) {
      auto methods = stepper_methods(time.loop, *report_.cycle, options_.cycle);
      methods.push_back(shooting_method(time.loop, *report_.cycle, options_.cycle));
      methods.push_back(balance_method(loop, *report_.cycle, options_.cycle));
      std::ranges::move(first_harmonic_methods(loop, *report_.cycle, options_.cycle), std::back_inserter(methods));
      std::ranges::copy(options_.more, std::back_inserter(methods));
      run_all(methods, chart, 0.05, 0.5);
    }
    conclude(chart);
    report_.cycle_chart = std::move(chart);
  }

  void ask_describing_function(const Element& element, const std::vector<DfPoint>& points) {
    tell(0.5, "describing functions");
    DfPrecisionOptions own = options_.df;
    own.work = options_.work;
    auto found = df_precision(element, points, own);
    WorkChart chart;
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
    report_.df_chart = std::move(chart);
  }

  void ask_stiffness(const LoopParts& parts) {
    const auto ladder = stiffness_ladder(parts);
    if (ladder.empty() || ladder.front().loop.delay > 0.0) return;
    CycleMethodsOptions own = options_.cycle;
    own.tolerances = options_.stiff_tolerances;
    own.periods = options_.stiff_periods;
    own.max_steps = options_.stiff_max_steps;
    WorkOptions work = options_.work;
    work.repeats = 1;
    for (std::size_t i = 0; i < ladder.size() && !stopped(); ++i) {
      tell(0.6 + 0.4 * static_cast<double>(i) / static_cast<double>(ladder.size()), "stiffness");
      StiffnessStudy one = stiffness_study({ladder[i]}, own, work, report_.cycle);
      std::ranges::move(one.points, std::back_inserter(report_.stiffness.points));
      std::ranges::move(one.notes, std::back_inserter(report_.stiffness.notes));
    }
  }

  bool stopped() const { return options_.work.stop && options_.work.stop(); }

  PrecisionReport take() {
    if (stopped()) report_.status = Status::interrupted;
    tell(1.0, "done");
    return std::move(report_);
  }

 private:
  void tell(double fraction, std::string_view what) const {
    if (options_.progress) options_.progress(fraction, what);
  }

  void run_all(const std::vector<WorkMethod>& methods, WorkChart& chart, double from, double to) {
    for (std::size_t i = 0; i < methods.size() && !stopped(); ++i) {
      tell(from + (to - from) * static_cast<double>(i) / static_cast<double>(methods.size()), methods[i].name);
      auto more = run_method(methods[i], options_.work);
      std::ranges::move(more, std::back_inserter(chart.points));
    }
  }

  const PrecisionOptions& options_;
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
  if (element != nullptr && !study.stopped()) study.ask_describing_function(*element, points);
  if (parts != nullptr && options.stiffness && !study.stopped()) study.ask_stiffness(*parts);
  return study.take();
}

}  // namespace limcycle
