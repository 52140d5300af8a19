#include "limcycle/analysis/study/precision/stability_families.hpp"

#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/study/precision/stiffness.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/non_drift.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"

namespace limcycle {
namespace {

struct Given {
  double Fs = 1.5, Fc = 1.0, vs = 1e-3, sigma2 = 0.0;
};

Given levels_of(const Element& law) {
  Given levels;
  levels.Fs = levels.Fc = law.number("Fc").value_or(levels.Fc);
  levels.Fs = law.number("Fs").value_or(levels.Fs);
  levels.vs = law.number("vs").value_or(levels.vs);
  levels.sigma2 = law.number("sigma2").value_or(levels.sigma2);
  return levels;
}

template <class Law>
Law with_levels(const Given& levels) {
  Law law;
  law.Fs = law.Fs_minus = levels.Fs;
  law.Fc = law.Fc_minus = levels.Fc;
  if constexpr (requires { law.vs; }) law.vs = levels.vs;
  law.sigma2 = levels.sigma2;
  return law;
}

template <class Law>
Law bristles(const Given& levels, double stiffness, double damping) {
  auto law = with_levels<Law>(levels);
  law.sigma0 = stiffness;
  law.sigma1 = damping;
  return law;
}

/// Four sliders of equal level, the stiffest four times as stiff as the softest.
Gms<double> four_sliders(const Given& levels, double stiffness, double damping) {
  auto law = with_levels<Gms<double>>(levels);
  law.alpha = {0.25, 0.25, 0.25, 0.25};
  for (const double share : {0.1, 0.2, 0.3, 0.4}) {
    law.k.push_back(share * stiffness);
    law.sigma1.push_back(share * damping);
  }
  law.C = 100.0 * levels.Fs;  // the level is reached in some ten milliseconds
  return law;
}

NonDrift<double> branches(const Given& levels, double stiffness, double damping) {
  auto law = with_levels<NonDrift<double>>(levels);
  law.Zb = levels.Fs / stiffness;
  law.sigma = damping;
  law.tau = 2e-3;
  return law;
}

Dahl<double> dahl(const Given& levels, double stiffness) {
  Dahl<double> law;
  law.Fc = levels.Fs;
  law.sigma0 = stiffness;
  return law;
}

/// kg: force over acceleration of the rubbing velocity.
double mass_seen(const LoopParts& parts) {
  const PlantModel plant = model_of(parts.plant);
  return 1.0 / (plant.C_v * plant.B_F).value();
}

}  // namespace

std::vector<double> atlas_stiffnesses() { return {1e3, 1e4, 1e5, 1e6, 1e7, 1e8}; }

std::vector<AtlasLoop> own_law(const LoopParts& parts) {
  if (!parts.friction) throw std::invalid_argument("loop.friction: the atlas of steppers needs a friction law");
  const std::string kind(parts.friction->kind());
  std::vector<AtlasLoop> loops;
  for (const StiffLoop& step : stiffness_ladder(parts)) loops.push_back({kind, step.sigma0, step.loop});
  if (loops.empty()) loops.push_back({kind, not_known, build_loop(parts)});
  return loops;
}

std::vector<AtlasLoop> law_families(const LoopParts& parts) {
  if (!parts.friction) throw std::invalid_argument("loop.friction: the atlas of steppers needs a friction law");
  const Given levels = levels_of(*parts.friction);
  std::vector<AtlasLoop> loops;
  const auto add = [&](const std::string& name, double stiffness, Element law) {
    LoopParts changed = parts;
    changed.friction = std::move(law);
    loops.push_back({name, stiffness, build_loop(changed)});
  };
  auto dry = with_levels<Coulomb<double>>(levels);
  add("coulomb", not_known, dry);
  const double mass = mass_seen(parts);
  const auto damping = [&](double stiffness) { return std::sqrt(stiffness * mass); };
  for (const double s : atlas_stiffnesses()) add("lugre", s, bristles<LuGre<double>>(levels, s, damping(s)));
  for (const double s : atlas_stiffnesses()) {
    auto law = bristles<ElastoPlastic<double>>(levels, s, damping(s));
    add("elasto-plastic", s, law);
  }
  for (const double s : atlas_stiffnesses()) add("gms", s, four_sliders(levels, s, damping(s)));
  for (const double s : atlas_stiffnesses()) add("non-drift", s, branches(levels, s, damping(s)));
  for (const double s : atlas_stiffnesses()) add("dahl", s, dahl(levels, s));
  return loops;
}

}  // namespace limcycle
