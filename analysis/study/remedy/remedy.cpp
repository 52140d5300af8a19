#include "limcycle/analysis/study/remedy/remedy.hpp"

#include <algorithm>
#include <numbers>

#include "limcycle/analysis/on_threads.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/predict/in_exact_time.hpp"
#include "limcycle/analysis/study/predict/loop_in_time.hpp"
#include "limcycle/analysis/study/remedy/dither.hpp"
#include "limcycle/analysis/study/remedy/impulse_remedy.hpp"
#include "limcycle/analysis/study/remedy/remedy_order.hpp"
#include "limcycle/analysis/study/remedy/remedy_search.hpp"

namespace limcycle {
namespace {

constexpr double before_remedies = 0.1;  ///< of the progress bar

/// "PATH=VALUE" with a value of four digits.
std::string shortened(const std::string& assignment) {
  const auto at = assignment.find('=') + 1;
  return assignment.substr(0, at) + short_number(std::stod(assignment.substr(at)), 4);
}

class RemedyStudy {
 public:
  RemedyStudy(const LoopParts& parts, const std::vector<RemedyCandidate>& candidates, const RemedyOptions& options)
      : parts_(parts), candidates_(candidates), options_(options) {}

  RemedyReport run() {
    look_at_the_loop();
    if (report_.hunts == Hunts::yes && !stopped()) {
      tell(0.05, "cause");
      report_.cause = cause_of(parts_, loop_.judging, loop_.cycles);
      try_all();
      for (const Remedy& one : report_.remedies)
        if (one.ends == true && (one.candidate.frequency > 0.0 || one.candidate.band > 0.0 || one.candidate.follows))
          report_.notes.push_back(one.candidate.name + ": " + one.why);
      order_remedies(report_.remedies, options_.weights);
    }
    if (stopped())
      report_.status = Status::interrupted;
    else if (report_.hunts == Hunts::undecided || std::ranges::any_of(report_.remedies, [](const Remedy& r) {
               return !r.ends && r.candidate.why_not.empty();
             }))
      report_.status = Status::incomplete;
    return std::move(report_);
  }

 private:
  bool stopped() const { return options_.predict.stop && options_.predict.stop(); }
  void tell(double fraction, std::string_view what) const {
    if (options_.predict.progress) options_.predict.progress(fraction, what);
  }

  void look_at_the_loop() {
    tell(0.0, "the loop as it stands");
    const Loop loop = build_loop(parts_);
    HuntsAnswer answer = hunts(loop, {options_.predict});
    report_.why = answer.why;
    report_.hunts = answer.hunts;
    loop_.judging = judging_of_variants(options_.predict, answer.found);
    loop_.box_is_given = options_.predict.search.has_value();
    loop_.followable = in_exact_time(loop).has_value() &&
                       std::ranges::any_of(answer.found.cycles, [](const Cycle& one) { return one.stable == true; });
    measure_motion(loop, answer.found);
    if (!answer.found.outcomes.empty()) report_.before = std::move(answer.found.outcomes.front().trace);
    report_.step = start_displacements(output_per_input(loop), answer.found.search, 1).front();
    report_.now = loop_costs(parts_, report_.step, report_.before, answer.hunts == Hunts::no);
    loop_.cycles = std::move(answer.found.cycles);
    loop_.states = state_names(loop_in_time(loop, 0.0).treated.loop);
  }

  /// Sizes of the motion, from the cycle or the motion without a period with the largest swing.
  void measure_motion(const Loop& loop, const PredictReport& found) {
    HuntingSizes sizes{0.0, 1.0, 1.0};
    const auto consider = [&](double swing, double period) {
      if (!(swing > sizes.displacement)) return;
      sizes.displacement = swing;
      sizes.frequency = 2.0 * std::numbers::pi / period;
    };
    for (const Cycle& cycle : found.cycles)
      if (cycle.stable == true) consider(cycle.amplitude, cycle.period);
    for (const OutcomeOfStart& one : found.outcomes)
      if (one.outcome == Outcome::irregular) consider(one.irregular.half_range, one.irregular.mean_period);
    sizes.force = loop.elements.back().scales().output;
    const Subject subject = subject_of(parts_);
    if (subject.element != nullptr && subject.opposes) {
      const Extent holds = holding_forces(*subject.element);
      if (holds.high - holds.low > 0.0) sizes.force = 0.5 * (holds.high - holds.low);
    }
    loop_.sizes = sizes;
  }

  void try_all() {
    report_.remedies.resize(candidates_.size());
    // The last ones, of the plant, take longest: they begin first, so that no thread waits for them in the end.
    const auto index = [&](std::size_t task) { return candidates_.size() - 1 - task; };
    share_tasks(
        options_.threads, candidates_.size(),
        [&](std::size_t task, const std::function<void(double)>& progress) {
          const std::size_t i = index(task);
          report_.remedies[i] = stopped() ? Remedy{candidates_[i], std::nullopt, 0.0, {}, {}, "interrupted"}
                                          : one(candidates_[i], [&](double fraction) { progress(0.95 * fraction); });
        },
        [&](double share, std::size_t task) {
          tell(before_remedies + (1.0 - before_remedies) * share, candidates_[index(task)].name);
        });
  }

  Remedy one(const RemedyCandidate& given, const std::function<void(double)>& progress) const {
    const RemedyCandidate candidate = given.sized ? given.sized(loop_.sizes) : given;
    if (!candidate.why_not.empty()) return {candidate, std::nullopt, 0.0, {}, {}, candidate.why_not};
    if (!candidate.in_vain.empty()) return {candidate, false, 0.0, {}, {}, candidate.in_vain};
    if (candidate.frequency > 0.0) return dithered(candidate, progress);
    Remedy remedy = candidate.band > 0.0 ? impulse_remedy(candidate, parts_.reference, loop_, progress)
                                         : RemedySearch(candidate, loop_, progress).run();
    if (remedy.ends != true || stopped()) return remedy;
    if (candidate.follows)
      for (const std::string& one : candidate.follows(remedy.value)) remedy.why += ", with " + shortened(one);
    if (const auto parts = candidate.parts(remedy.value))
      remedy.costs = loop_costs(*parts, report_.step, remedy.after, true);
    remedy.costs.robust_share = robust_share(remedy);
    return remedy;
  }

  /// Its costs are those that do not depend on the friction: the motion under dither has no rest.
  Remedy dithered(const RemedyCandidate& candidate, const std::function<void(double)>& progress) const {
    Remedy remedy = dither_remedy(candidate, parts_, loop_, report_.step, progress);
    if (remedy.ends != true) return remedy;
    remedy.costs = loop_costs(parts_, report_.step, {}, false);
    remedy.costs.steady_state_error.reset();
    return remedy;
  }

  /// Empty if more than a tenth of the samples were not decided.
  std::optional<double> robust_share(const Remedy& remedy) const {
    if (!options_.sampled || options_.samples == 0) return std::nullopt;
    const Judging judging = hurried(loop_.judging);
    std::size_t rest = 0, decided = 0;
    for (std::size_t k = 0; k < options_.samples; ++k) {
      if (stopped()) return std::nullopt;
      const auto parts = options_.sampled(remedy.candidate, remedy.value, k);
      const Hunts here = parts ? hunts(build_loop(*parts), judging).hunts : Hunts::undecided;
      if (here != Hunts::undecided) ++decided;
      if (here == Hunts::no) ++rest;
    }
    if (10 * decided < 9 * options_.samples) return std::nullopt;
    return static_cast<double>(rest) / static_cast<double>(decided);
  }

  const LoopParts& parts_;
  const std::vector<RemedyCandidate>& candidates_;
  const RemedyOptions& options_;
  RemedyReport report_;
  HuntingLoop loop_;
};

}  // namespace

RemedyReport remedies(const LoopParts& parts, const std::vector<RemedyCandidate>& candidates,
                      const RemedyOptions& options) {
  return RemedyStudy(parts, candidates, options).run();
}

}  // namespace limcycle
