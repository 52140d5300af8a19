#include "limcycle/cli/report_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "limcycle/analysis/study/balance/roots/nyquist.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"
#include "limcycle/analysis/study/sensitivity/local_sensitivity.hpp"
#include "limcycle/analysis/sweep.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/loop_variation.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/map_of.hpp"
#include "limcycle/cli/precision_of.hpp"
#include "limcycle/questions/map.hpp"
#include "limcycle/questions/margin.hpp"
#include "limcycle/questions/predict.hpp"
#include "limcycle/questions/remedy.hpp"
#include "limcycle/questions/threshold.hpp"

namespace limcycle {
namespace {

/// Inputs of a part.
struct ReportQuestion {
  const Case& from;
  const Loop& loop;
  const ReportWishes& wishes;
  const CommonFlags& flags;
  const PredictReport& predicted;
};

ReportPart<SensitivityReport> sensitivity_part(const ReportQuestion& ask) {
  SensitivityReport report;
  const auto numbers = loop_numbers(ask.from);
  if (const Cycle* cycle = largest_stable(ask.predicted.cycles)) report.cycle = *cycle;
  if (report.cycle && ask.loop.delay == 0.0)
    report.local = local_sensitivities(ask.loop, *report.cycle, numbers, interrupted);
  else if (report.cycle)
    report.notes.emplace_back("the delay: derivatives of a cycle are not computed for loops with a delay");
  report.predicted = predicted_sensitivities(ask.loop, ask.predicted.search, numbers, report.notes, interrupted);
  if (!report.local.empty() || !report.predicted.empty()) return {std::move(report), {}};
  if (report.cycle)
    return {{},
            "The loop has a dead time: the derivatives of its limit cycle are not computed for such loops, and the "
            "describing function predicts no oscillation to differentiate."};
  return {
      {},
      "There is no stable limit cycle, and the describing function predicts none: there is nothing to differentiate."};
}

Asking asking(const ReportQuestion& ask, const std::function<void(double)>& progress) {
  Asking asked;
  asked.stop = interrupted;
  asked.progress = [progress](double fraction, std::string_view) { progress(fraction); };
  asked.threads = ask.flags.threads;
  asked.seed = ask.flags.seed;
  return asked;
}

ReportPart<MarginReport> margin_part(const ReportQuestion& ask, const std::function<void(double)>& progress) {
  MarginReport report = ask_margin(ask.from, {}, asking(ask, progress));
  if (!report.refused.empty()) return {{}, "Margins: " + report.refused + "."};
  return {std::move(report), {}};
}

ReportPart<RemedyReport> remedy_part(const ReportQuestion& ask, const std::function<void(double)>& progress) {
  return {ask_remedy(ask.from, {}, asking(ask, progress)), {}};
}

constexpr Methods methods_of_map{true, false, false};

ReportPart<MapReport> map_part(const ReportQuestion& ask, const std::function<void(double)>& progress) {
  MapReport report = map_of(ask.from, ask.wishes.x, ask.wishes.y, methods_of_map);
  HuntingMap& map = report.map;
  map.points.resize(map.size());
  const PredictOptions options = map_options(ask.from, methods_of_map, interrupted);
  const std::string paths[] = {map.x.path, map.y.path};
  const LoopVariation variation(ask.from, "--x, --y", paths);
  SweepOptions sweep;
  sweep.threads = ask.flags.threads;
  sweep.stop = interrupted;
  sweep.progress = [&](std::size_t done, std::size_t total) {
    progress(static_cast<double>(done) / static_cast<double>(total));
  };
  run_each(
      map.size(),
      [&](std::size_t k) {
        MapPoint point = point_of(map, k, variation, options);
        if (!interrupted()) map.points[k] = std::move(point);
      },
      sweep);
  if (map.known() == 0) return {{}, "Interrupted before a point of the map was computed."};
  return {std::move(report), {}};
}

/// The run of [simulate], or one period from a point of the limit cycle.
std::optional<SimulateOptions> run_to_count(const ReportQuestion& ask, std::string& which) {
  if (ask.from.simulate) {
    which = "the run of [simulate]";
    return ask.from.simulate;
  }
  const Cycle* cycle = largest_stable(ask.predicted.cycles);
  if (cycle == nullptr) return std::nullopt;
  const auto names = state_names(ask.loop);
  if (names.size() != cycle->start.x.size()) return std::nullopt;
  SimulateOptions options;
  options.duration = cycle->period;
  const State values = own_values(ask.loop, cycle->start.x);
  for (std::size_t i = 0; i < names.size(); ++i) options.initial[names[i]] = values[i];
  which = "one period from a point of the limit cycle";
  return options;
}

ReportPart<CountedRun> energy_part(const ReportQuestion& ask) {
  if (!has_energy(*ask.from.loop))
    return {{},
            ask.from.loop->diagram ? "The energy balance of a diagram is not computed."
                                   : "The loop has neither friction nor a mechanical plant: there is no energy "
                                     "balance."};
  CountedRun counted;
  auto options = run_to_count(ask, counted.which);
  if (!options)
    return {{},
            "The case has no [simulate] section and the loop has no stable limit cycle: there is no run to balance."};
  EnergyAudit audit(*ask.from.loop, ask.loop, options->rtol);
  options->stop = interrupted;
  options->watch = [&](LoopField& field, March& march, const std::vector<Mode>& modes) {
    audit.step(field, march, modes);
  };
  counted.run = simulate(ask.loop, *options);
  counted.energy = audit.balance();
  if (counted.run.status != Status::converged)
    return {{},
            "The run for the energy balance did not reach its end: " +
                (counted.run.why.empty() ? std::string(to_string(counted.run.status)) : counted.run.why) + "."};
  return {std::move(counted), {}};
}

ReportPart<DissipativityReport> dissipativity_part(const ReportQuestion& ask) {
  const LoopParts& parts = *ask.from.loop;
  const Subject subject = subject_of(parts);
  if (subject.element == nullptr || subject.path == "loop.error")
    return {{},
            parts.diagram ? "The diagram has several friction laws or elements: one is examined at a time."
                          : "The loop has neither friction nor an element in series: there is no law to examine."};
  DissipativityOptions options;
  options.speed = ask.from.dissipativity.speed;
  options.passivity.top_speed = ask.from.dissipativity.top_speed;
  options.passivity.seed = ask.flags.seed;
  options.passivity.stop = interrupted;
  options.predict = ask.from.predict;
  return {dissipativity(parts, options), {}};
}

ReportPart<PrecisionReport> precision_part(const ReportQuestion& ask) {
  PrecisionOptions options;
  options.cycle.predict = ask.from.predict;
  options.cycle.predict.stop = options.work.stop = interrupted;
  options.stiffness = false;
  PrecisionReport report = precision_of(ask.from, options);
  if (report.cycle_chart || report.df_chart) return {std::move(report), {}};
  return {{}, "There is neither a limit cycle nor a friction law to measure the methods on."};
}

/// One part, whether it succeeds or not.
template <class Result>
ReportPart<Result> attempted(bool wanted, auto&& compute) {
  if (!wanted) return {};
  if (interrupted()) return {{}, "Interrupted before this was computed."};
  try {
    return compute();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return {{}, std::string("This could not be computed: ") + error.what() + "."};
  }
}

}  // namespace

void check_wishes(const Case& from, const ReportWishes& wishes) {
  if (wishes.x.empty() != wishes.y.empty())
    throw refusal(wishes.x.empty() ? "--y " + wishes.y : "--x " + wishes.x, "a map needs both --x and --y");
  if (wishes.x.empty()) return;
  map_of(from, wishes.x, wishes.y, methods_of_map);
}

LoopReport report_parts(const Case& from, const ReportWishes& wishes, const CommonFlags& flags, Progress& progress) {
  LoopReport report;
  report.loop = *from.loop;
  const Loop loop = build_loop(report.loop);
  PredictOptions options = from.predict;
  options.stop = interrupted;
  options.progress = [&](double fraction, std::string_view what) { progress.show(0.3 * fraction, what); };
  report.predict = answer_of([&] { return predict(loop, options); });
  report.predict.nyquist = nyquist_picture(loop, report.predict, options.stop);
  add_cause(report.predict, report.loop, options);
  const ReportQuestion ask{from, loop, wishes, flags, report.predict};
  const auto part_of_bar = [&](double from_share, double to_share, std::string_view what) {
    return [&progress, from_share, to_share, what](double fraction) {
      progress.show(from_share + (to_share - from_share) * fraction, what);
    };
  };
  report.margin =
      attempted<MarginReport>(!wishes.quick, [&] { return margin_part(ask, part_of_bar(0.3, 0.4, "margins")); });
  report.remedy =
      attempted<RemedyReport>(wishes.remedies, [&] { return remedy_part(ask, part_of_bar(0.4, 0.6, "remedies")); });
  progress.show(0.6, "sensitivity");
  report.sensitivity = attempted<SensitivityReport>(!wishes.quick, [&] { return sensitivity_part(ask); });
  progress.show(0.65, "energy balance");
  report.energy = attempted<CountedRun>(true, [&] { return energy_part(ask); });
  progress.show(0.7, "dissipativity");
  report.dissipativity = attempted<DissipativityReport>(!wishes.quick, [&] { return dissipativity_part(ask); });
  report.map =
      attempted<MapReport>(!wishes.x.empty(), [&] { return map_part(ask, part_of_bar(0.75, 0.85, "the map")); });
  progress.show(0.85, "accuracy and cost");
  report.precision = attempted<PrecisionReport>(wishes.benchmarks, [&] { return precision_part(ask); });
  report.interrupted = interrupted();
  if (report.interrupted) report.predict.status = Status::interrupted;  // the document of the page states it too
  return report;
}

}  // namespace limcycle
