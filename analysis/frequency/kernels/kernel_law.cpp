#include "limcycle/analysis/frequency/kernels/kernel_law.hpp"

#include <cmath>

#include "limcycle/models/friction/bristle/bouc_wen.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/sliders/xiong.hpp"

namespace limcycle {

namespace {

template <class Law>
double kink_of(const Law& law) {
  const double delta = law.curve.index == 1 ? 1.0 : law.delta;
  return std::fmod(delta, 2.0) == 0.0 ? 0.0 : delta == std::floor(delta) ? 1.0 : delta;
}

template <class Law>
MarchNumbers level_of(const Law& law) {
  MarchNumbers numbers;
  numbers.ratio = law.Fc / law.Fs;
  numbers.delta = law.delta;
  numbers.curve = law.curve.index;
  return numbers;
}

KernelLaw marched(const ElastoPlastic<double>& law) {
  KernelState state{.law = MarchLaw::elasto_plastic, .numbers = level_of(law)};
  if (law.zba_of.index == 0)
    state.numbers.share = law.zba_ratio;
  else
    state.numbers.fixed = law.zba_ratio * law.Fc / law.Fs;
  state.reach = law.sigma0 / law.Fs;
  state.speed = 1.0 / law.vs;
  state.force = law.Fs;
  state.damping = law.sigma1 * law.Fs / law.sigma0;
  return {{state}, 0.0, law.sigma2, kink_of(law), 1.5};
}

KernelLaw marched(const Xiong<double>& law) {
  KernelLaw all{{}, 0.0, law.sigma2, kink_of(law), 2.0};
  for (std::size_t i = 0; i < law.K.size(); ++i) {
    KernelState state{.law = MarchLaw::capped, .numbers = level_of(law)};
    state.force = law.lambda[i] * law.Fs;
    state.reach = law.K[i] / state.force;
    state.speed = 1.0 / law.vs;
    state.tempo = law.K[i] / law.sigma[i];
    state.drag = law.sigma[i] / state.force;
    state.lag = 1.0 / law.tau;
    state.damping = law.sigma[i] / law.K[i] * state.force;
    all.states.push_back(state);
  }
  return all;
}

KernelLaw marched(const Dahl<double>& law) {
  KernelState state{.law = MarchLaw::dahl, .numbers = {}};
  state.numbers.exponent = law.exponent;
  state.reach = law.sigma0 / law.Fc;
  state.force = law.Fc;
  KernelLaw all{{state}};
  all.knows_rate = false;
  return all;
}

KernelLaw marched(const BoucWen<double>& law) {
  KernelState state{.law = MarchLaw::bouc_wen, .numbers = {}};
  const double largest = law.largest();
  state.numbers.exponent = law.n;
  state.numbers.curvature = (law.gamma - law.beta) / (law.gamma + law.beta);
  state.reach = law.A / (law.D * largest);
  state.force = (1.0 - law.alpha) * law.k * law.D * largest;
  const bool whole = law.n == std::floor(law.n);
  KernelLaw all{{state}, law.alpha * law.k};
  // |u|^n has a kink or a branch point where u changes sign.
  all.trust = whole ? 3.0 : 6.0;
  all.least = !whole ? 5e-8 : law.n == 1.0 ? 2e-9 : 0.0;
  all.knows_rate = false;
  return all;
}

}  // namespace

std::optional<KernelLaw> KernelLaw::of(const Element& element) {
  if (const auto* law = element.as<ElastoPlastic<double>>())
    return law->odd() && law->vd == 0.0 && law->zba_ratio < 1.0 ? std::optional(marched(*law)) : std::nullopt;
  if (const auto* law = element.as<Xiong<double>>()) return law->odd() ? std::optional(marched(*law)) : std::nullopt;
  if (const auto* law = element.as<Dahl<double>>())
    return law->exponent > 1.0 ? std::optional(marched(*law)) : std::nullopt;
  if (const auto* law = element.as<BoucWen<double>>())
    return law->beta >= 0.0 && (law->n == 1.0 || law->n >= 2.0) ? std::optional(marched(*law)) : std::nullopt;
  return std::nullopt;
}

}  // namespace limcycle
