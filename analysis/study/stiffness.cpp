#include "limcycle/analysis/study/stiffness.hpp"

#include <cmath>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

/// Sets sigma0 of a law that has one, and sigma1 with it.
bool set_stiffness(Element<double>& element, double factor) {
  return std::visit(
      [&](auto& law) {
        if constexpr (requires { law.sigma0 *= factor; }) {
          law.sigma0 *= factor;
          if constexpr (requires { law.sigma1 *= factor; }) law.sigma1 *= std::sqrt(factor);
          return true;
        }
        return false;
      },
      element);
}

double stiffness_of(const Element<double>& element) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { double(law.sigma0); }) return double(law.sigma0);
        return 0.0;
      },
      element);
}

}  // namespace

std::vector<StiffLoop> stiffness_ladder(const LoopParts& parts) {
  std::vector<StiffLoop> ladder;
  if (!parts.friction || stiffness_of(*parts.friction) <= 0.0) return ladder;
  for (int decade = -2; decade <= 3; ++decade) {
    LoopParts changed = parts;
    if (!set_stiffness(*changed.friction, std::pow(10.0, decade))) return ladder;
    ladder.push_back({stiffness_of(*changed.friction), build_loop(changed)});
  }
  return ladder;
}

StiffnessStudy stiffness_study(const std::vector<StiffLoop>& ladder, const CycleMethodsOptions& options,
                               const WorkOptions& work) {
  StiffnessStudy study;
  for (const StiffLoop& step : ladder) {
    if (work.stop && work.stop()) break;
    std::string why;
    const std::string where = "sigma0 = " + short_number(step.sigma0) + ": ";
    const auto reference = cycle_reference(step.loop, options.predict, options.check_steps, why);
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
