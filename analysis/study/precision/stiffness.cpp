#include "limcycle/analysis/study/precision/stiffness.hpp"

#include <cmath>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

/// The law with sigma0 times a factor, and sigma1 changed so that the damping ratio of the bristles is the same.
Element stiffer(const Element& law, double factor) {
  Element changed = law.with("sigma0", *law.number("sigma0") * factor);
  if (const auto damping = law.number("sigma1")) changed = changed.with("sigma1", *damping * std::sqrt(factor));
  return changed;
}

double stiffness_of(const Element& law) { return law.number("sigma0").value_or(0.0); }

}  // namespace

std::vector<StiffLoop> stiffness_ladder(const LoopParts& parts) {
  std::vector<StiffLoop> ladder;
  if (!parts.friction || stiffness_of(*parts.friction) <= 0.0) return ladder;
  for (int decade = -2; decade <= 3; ++decade) {
    LoopParts changed = parts;
    changed.friction = stiffer(*parts.friction, std::pow(10.0, decade));
    ladder.push_back({stiffness_of(*changed.friction), build_loop(changed), decade == 0});
  }
  return ladder;
}

StiffnessStudy stiffness_study(const std::vector<StiffLoop>& ladder, const CycleMethodsOptions& options,
                               const WorkOptions& work, const std::optional<CycleReference>& own) {
  StiffnessStudy study;
  for (const StiffLoop& step : ladder) {
    if (work.stop && work.stop()) break;
    std::string why;
    const std::string where = "sigma0 = " + short_number(step.sigma0) + ": ";
    const auto reference = own && own->verified() && step.own
                               ? own
                               : cycle_reference(step.loop, options.predict, options.check_steps, why);
    if (!reference || !reference->verified()) {
      if (!(work.stop && work.stop())) study.notes.push_back(where + "no verified reference, " + why);
      continue;
    }
    study.notes.push_back(where + "reference period " + short_number(reference->cycle.period, 8) + " s, confirmed to " +
                          short_number(reference->agreement, 2) + " by " + reference->verified_by +
                          (reference->independent ? "" : " (the same stepper: others gave up, so a weaker check)"));
    for (const auto& method : stepper_methods(step.loop, *reference, options))
      for (auto& point : run_method(method, work))
        study.points.push_back({step.sigma0, reference->cycle.period, std::move(point)});
  }
  return study;
}

}  // namespace limcycle
