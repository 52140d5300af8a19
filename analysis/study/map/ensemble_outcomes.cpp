#include "limcycle/analysis/study/map/ensemble_outcomes.hpp"

#include <algorithm>
#include <limits>

#include "limcycle/analysis/orbit/simulate/ensemble.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/delay.hpp"

namespace limcycle {
namespace {

constexpr double no_answer = std::numeric_limits<double>::quiet_NaN();
constexpr int delay_order = 8;  // of the Pade approximation, if a delay does not act through a relay

EnsembleOutcome from_starts(std::span<const EnsembleResult> starts) {
  EnsembleOutcome answer{0.0, no_answer, no_answer};
  for (const EnsembleResult& start : starts) {
    if (start.outcome == Outcome::cycle) {
      answer.hunts = 1.0;
      if (start.amplitude <= answer.amplitude) continue;
      answer.amplitude = start.amplitude;
      answer.period = start.period;
    }
  }
  // A motion that continues for ever in another way is neither a limit cycle nor rest.
  const auto undecided = [](const EnsembleResult& start) {
    return start.outcome == Outcome::undecided || start.outcome == Outcome::family ||
           start.outcome == Outcome::irregular;
  };
  if (answer.hunts == 0.0 && std::ranges::any_of(starts, undecided)) answer.hunts = no_answer;
  return answer;
}

}  // namespace

EnsembleQuestion ensemble_question(const Loop& loop) {
  const SearchBox box = default_search_box(loop);
  const double unit = output_per_input(loop);
  EnsembleQuestion question;
  question.displacements = {unit * box.amplitude_max, 0.01 * unit * box.amplitude_max};
  const SettleOptions search = cycle_search(loop, box, question.accuracy);
  question.amplitude_floor = search.amplitude_floor;
  question.amplitude_ceiling = search.amplitude_ceiling;
  question.rtol = std::min(question.rtol, search.rtol);
  return question;
}

std::vector<EnsembleOutcome> ensemble_outcomes(std::span<const std::optional<Loop>> loops,
                                               const EnsembleQuestion& question) {
  std::vector<std::optional<Loop>> in_time(loops.size());
  std::vector<EnsembleMember> members;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!loops[i]) continue;
    const Loop* loop = &*loops[i];
    if (loop->delay > 0.0) {
      in_time[i] = in_time_domain(*loop, delay_order).loop;
      loop = &*in_time[i];
    }
    for (const double displacement : question.displacements) members.push_back({loop, displaced(*loop, displacement)});
  }
  EnsembleOptions options;
  options.amplitude_floor = question.amplitude_floor;
  options.amplitude_ceiling = question.amplitude_ceiling;
  options.accuracy = question.accuracy;
  options.rtol = question.rtol;
  options.isa = question.isa;
  options.stop = question.stop;
  const EnsembleRun run = run_ensemble(members, options);

  std::vector<EnsembleOutcome> answers;
  const std::size_t starts = question.displacements.size();
  std::size_t next = 0;
  for (const auto& loop : loops) {
    if (!loop) {
      answers.push_back({no_answer, no_answer, no_answer});
      continue;
    }
    const auto own = std::span(run.members).subspan(next, starts);
    next += starts;
    if (std::ranges::any_of(own, [](const auto& one) { return one.status == Status::interrupted; })) return answers;
    answers.push_back(from_starts(own));
  }
  return answers;
}

}  // namespace limcycle
