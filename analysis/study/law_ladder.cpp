#include "limcycle/analysis/study/law_ladder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr int sliders = 4;
constexpr double shape = 5.0;  ///< of the non-drift law's exponential branch

/// What the parameters of any law say of levels, curve, stiffness and damping.
struct Traits {
  std::optional<double> Fs, Fc, Fs_minus, Fc_minus, vs, sigma0, sigma1;
  double delta = 2.0, sigma2 = 0.0, vd = 0.0, zba_ratio = 0.69;
  Choice curve{}, zba_of{};
};

template <class Law>
std::optional<double> number(const Law& law, std::string_view key) {
  for (const auto& parameter : Law::parameters())
    if (const auto* member = std::get_if<double Law::*>(&parameter.member); member && parameter.key == key)
      return law.*(*member);
  return std::nullopt;
}

template <class Law>
std::optional<double> sum_of_list(const Law& law, std::string_view key) {
  for (const auto& parameter : Law::parameters())
    if (const auto* member = std::get_if<std::vector<double> Law::*>(&parameter.member); member && parameter.key == key)
      return std::accumulate((law.*(*member)).begin(), (law.*(*member)).end(), 0.0);
  return std::nullopt;
}

template <class Law>
std::optional<double> first_of(const Law& law, std::initializer_list<std::string_view> keys) {
  for (const auto key : keys) {
    if (const auto value = number(law, key)) return value;
    if (const auto value = sum_of_list(law, key)) return value;
  }
  return std::nullopt;
}

template <class Law>
Traits traits_of(const Law& law) {
  Traits t;
  t.Fc = first_of(law, {"Fc", "W"});
  t.Fs = number(law, "Fs") ? number(law, "Fs") : t.Fc;
  t.Fs_minus = number(law, "Fs_minus");
  t.Fc_minus = number(law, "Fc_minus");
  t.vs = number(law, "vs");
  t.sigma0 = first_of(law, {"sigma0", "ks", "k", "K"});
  if (!t.sigma0 && t.Fs)
    if (const auto range = first_of(law, {"Zb", "s"})) t.sigma0 = *t.Fs / *range;
  t.sigma1 = first_of(law, {"sigma1", "B", "sigma"});
  t.delta = number(law, "delta").value_or(2.0);
  t.sigma2 = number(law, "sigma2").value_or(0.0);
  t.vd = number(law, "vd").value_or(0.0);
  if constexpr (requires { law.curve; })
    if constexpr (std::is_same_v<std::decay_t<decltype(law.curve)>, Choice> && requires { law.vs; })
      t.curve = law.curve;
  if constexpr (requires { law.zba_ratio; }) {
    t.zba_ratio = law.zba_ratio;
    t.zba_of = law.zba_of;
  }
  return t;
}

/// A rung, or why there is none.
class Builder {
 public:
  explicit Builder(const Traits& traits) : t_(traits) {}

  LawRung coulomb(bool stiction) const {
    LawRung rung{stiction ? "coulomb + stiction" : "coulomb", {}, {}};
    if (missing(rung, {&t_.Fc})) return rung;
    Coulomb<double> law;
    set_levels(law, stiction);
    law.sigma2 = t_.sigma2;
    rung.law = law;
    rung.rule = stiction ? "same Fs, Fc, sigma2; no Stribeck curve, no bristles" : "same Fc, sigma2; Fs = Fc";
    return rung;
  }
  LawRung stribeck() const {
    LawRung rung{"stribeck", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.vs})) return rung;
    Stribeck<double> law;
    set_curve(law);
    law.sigma2 = t_.sigma2;
    rung.law = law;
    rung.rule = "same Fs, Fc, vs, delta, curve, sigma2; no bristles";
    return rung;
  }
  LawRung dahl() const {
    LawRung rung{"dahl", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.sigma0})) return rung;
    Dahl<double> law;
    law.Fc = *t_.Fc;
    law.sigma0 = *t_.sigma0;
    rung.law = law;
    rung.rule = "same Fc, sigma0, exponent 1; Fs, the Stribeck curve, sigma1 and sigma2 dropped";
    return rung;
  }
  LawRung lugre() const {
    LawRung rung{"lugre", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.vs, &t_.sigma0})) return rung;
    LuGre<double> law;
    set_bristles(law);
    rung.law = law;
    rung.rule = "same levels, curve, sigma0, sigma1, sigma2";
    return rung;
  }
  LawRung elasto_plastic() const {
    LawRung rung{"elasto-plastic", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.vs, &t_.sigma0})) return rung;
    ElastoPlastic<double> law;
    set_bristles(law);
    law.zba_ratio = t_.zba_ratio;
    law.zba_of = t_.zba_of;
    rung.law = law;
    rung.rule = "as lugre, elastic up to zba_ratio = " + short_number(t_.zba_ratio) + " of the steady deflection";
    return rung;
  }
  LawRung multi_state() const {
    LawRung rung{"multi-state", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.sigma0})) return rung;
    std::vector<double> k(static_cast<std::size_t>(sliders));
    for (int i = 0; i < sliders; ++i)
      k[static_cast<std::size_t>(i)] = *t_.sigma0 * std::ldexp(1.0, sliders - 1 - i) / (std::ldexp(1.0, sliders) - 1.0);
    const std::string springs = std::to_string(sliders) + " sliders of equal share, stiffness 8:4:2:1, sum sigma0";
    if (!t_.vs) {
      MaxwellSlip<double> law;
      law.k = k;
      law.W.assign(sliders, *t_.Fc / sliders);
      rung.law = law;
      rung.rule = "maxwell-slip: " + springs + ", limits Fc/4; sigma2 dropped";
      return rung;
    }
    Gms<double> law;
    set_curve(law);
    law.alpha.assign(sliders, 1.0 / sliders);
    law.C = *t_.sigma0 * *t_.vs;
    law.sigma2 = t_.sigma2;
    for (const double stiffness : k) law.sigma1.push_back(t_.sigma1.value_or(0.0) * stiffness / *t_.sigma0);
    law.k = std::move(k);
    rung.law = law;
    rung.rule = "gms: " + springs + "; C = sigma0 vs; sigma1_i = sigma1 k_i/sigma0; same levels, curve, sigma2";
    return rung;
  }
  LawRung non_drift() const {
    LawRung rung{"non-drift", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.vs, &t_.sigma0})) return rung;
    if (!(t_.sigma1.value_or(0.0) > 0.0)) {
      rung.rule = "not possible: the law needs a bristle damping, and the case's law has none";
      return rung;
    }
    NonDrift<double> law;
    set_curve(law);
    law.shape = shape;
    law.branch = {1};
    law.Zb = shape / -std::expm1(-shape) * *t_.Fs / *t_.sigma0;
    law.sigma = *t_.sigma1;
    law.sigma2 = t_.sigma2;
    rung.law = law;
    rung.rule =
        "exponential branch of shape 5 that begins with stiffness sigma0 (Zb = 5.03 Fs/sigma0); sigma = sigma1; "
        "tau = 0; same levels, curve, sigma2";
    return rung;
  }

 private:
  bool missing(LawRung& rung, std::initializer_list<const std::optional<double>*> needed) const {
    for (const auto* one : needed) {
      if (*one) continue;
      rung.rule = std::string("not possible: the case's law has no ") + (one == &t_.Fc   ? "sliding level"
                                                                         : one == &t_.vs ? "Stribeck velocity"
                                                                                         : "bristle stiffness");
      return true;
    }
    return false;
  }
  template <class Law>
  void set_levels(Law& law, bool stiction) const {
    law.Fc = *t_.Fc;
    law.Fc_minus = t_.Fc_minus.value_or(law.Fc);
    law.Fs = stiction ? *t_.Fs : law.Fc;
    law.Fs_minus = stiction ? t_.Fs_minus.value_or(law.Fs) : law.Fc_minus;
  }
  template <class Law>
  void set_curve(Law& law) const {
    set_levels(law, true);
    law.vs = *t_.vs;
    law.delta = t_.delta;
    law.curve = t_.curve;
  }
  template <class Law>
  void set_bristles(Law& law) const {
    set_curve(law);
    law.sigma0 = *t_.sigma0;
    law.sigma1 = t_.sigma1.value_or(0.0);
    law.sigma2 = t_.sigma2;
    law.vd = t_.vd;
  }

  Traits t_;
};

/// The rung that a law stands on itself; the number of rungs if on none.
std::size_t own_rung(const Element<double>& own) {
  const std::string_view kind = law_kind(own);
  if (kind == "coulomb") {
    const auto& law = std::get<Coulomb<double>>(own);
    return law.Fs > law.Fc || law.Fs_minus > law.Fc_minus ? 1 : 0;
  }
  for (const auto multi : {"gms", "maxwell-slip", "leuven", "iwan", "xiong"})
    if (kind == multi) return 6;
  constexpr std::string_view kinds[] = {"", "", "stribeck", "dahl", "lugre", "elasto-plastic", "", "non-drift"};
  return static_cast<std::size_t>(std::ranges::find(kinds, kind) - std::begin(kinds));
}

/// Changes the number of that key, and those that follow it, by a factor.
template <class Law>
void scale(Law& law, const Parameter<Law, double>& chosen, double Law::*member, double factor) {
  const double before = law.*member;
  for (const auto& other : Law::parameters())
    if (const auto* follower = std::get_if<double Law::*>(&other.member);
        follower && other.default_from == chosen.key && law.*(*follower) == before)
      law.*(*follower) *= factor;
  law.*member *= factor;
}

template <class Law>
void add_variations(const Law& own, double spread, std::vector<LawVariation>& list) {
  for (const auto& parameter : Law::parameters()) {
    const auto* member = std::get_if<double Law::*>(&parameter.member);
    if (member == nullptr || own.*(*member) == 0.0 || !std::isfinite(own.*(*member))) continue;
    if (const auto source = number(own, parameter.default_from); source && *source == own.*(*member)) continue;
    for (const double sign : {-1.0, 1.0}) {
      Law law = own;
      scale(law, parameter, *member, 1.0 + sign * spread);
      if (law.validate() || !parameter.range.contains(law.*(*member))) continue;
      list.push_back(
          {std::string(parameter.key) + (sign < 0.0 ? " -" : " +") + short_number(100.0 * spread) + " %", law});
    }
  }
}

}  // namespace

std::string_view law_kind(const Element<double>& law) {
  return std::visit([]<class Law>(const Law&) { return Law::kind; }, law);
}

std::vector<LawRung> law_ladder(const Element<double>& own) {
  const Traits traits = std::visit(
      []<class Law>(const Law& law) {
        if constexpr (FrictionLaws::contains<Law>) return traits_of(law);
        return Traits{};
      },
      own);
  const Builder build(traits);
  std::vector<LawRung> ladder{build.coulomb(false), build.coulomb(true),    build.stribeck(),    build.dahl(),
                              build.lugre(),        build.elasto_plastic(), build.multi_state(), build.non_drift()};
  const std::size_t at = own_rung(own);
  if (at >= ladder.size()) ladder.push_back({std::string(law_kind(own)), {}, {}});
  LawRung& rung = ladder[std::min(at, ladder.size() - 1)];
  if (rung.name == "multi-state") rung.name = law_kind(own);
  rung.law = own;
  rung.rule = "the case's own law";
  rung.own = true;
  return ladder;
}

std::vector<LawVariation> law_variations(const Element<double>& own, double spread) {
  std::vector<LawVariation> list;
  std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (FrictionLaws::contains<Law>) add_variations(law, spread, list);
      },
      own);
  return list;
}

}  // namespace limcycle
