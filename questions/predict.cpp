#include "limcycle/questions/predict.hpp"

#include <algorithm>

#include "limcycle/analysis/study/balance/roots/nyquist.hpp"
#include "limcycle/analysis/study/predict/interest.hpp"
#include "limcycle/analysis/study/remedy/cause.hpp"

namespace limcycle {
namespace {

bool hunts_in_box(const PredictReport& report) {
  return std::ranges::any_of(
             report.cycles,
             [&](const Cycle& one) { return one.stable == true && is_of_interest(report.search, one); }) ||
         std::ranges::any_of(report.outcomes,
                             [](const OutcomeOfStart& one) { return one.outcome == Outcome::irregular; });
}

}  // namespace

PredictReport ask_predict(const Case& from, const Asking& asking, bool curves) {
  PredictOptions options = from.predict;
  options.stop = asking.stop;
  options.progress = asking.progress;
  const LoopParts& parts = need_loop(from);
  const Loop loop = build_loop(parts);
  PredictReport report = predict(loop, options);
  if (curves) report.nyquist = nyquist_picture(loop, report, options.stop);
  add_cause(report, parts, options);
  if (from.simulate && from.simulate->force)
    report.notes.emplace_back("the force of [simulate] is no part of this prediction: limcycle simulate applies it");
  return report;
}

void add_cause(PredictReport& report, const LoopParts& parts, const PredictOptions& options) {
  if (report.status == Status::interrupted || !hunts_in_box(report)) return;
  Cause cause = cause_of(parts, judging_of_variants(options, report), report.cycles);
  if (options.stop && options.stop())
    report.notes.emplace_back("interrupted before it was known why the loop hunts");
  else
    report.cause = HuntingCause{std::string(to_string(cause.kind)), std::move(cause.why)};
}

}  // namespace limcycle
