#include "limcycle/analysis/study/adequacy/simplified_laws.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/catalogue.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/non_drift.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"
#include "limcycle/models/friction/sliders/maxwell_slip.hpp"

namespace limcycle {
namespace {

constexpr int sliders = 4;
constexpr double shape = 5.0;  ///< of the non-drift law's exponential branch

/// Levels, curve, stiffness and damping from the parameters of any law.
struct Traits {
  std::optional<double> Fs, Fc, Fs_minus, Fc_minus, vs, sigma0, sigma1;
  double delta = 2.0, sigma2 = 0.0, vd = 0.0, zba_ratio = 0.69;
  Choice curve{}, zba_of{};
};

/// The value of that key if it is of that type.
template <class Type>
std::optional<Type> value_of(const Element& law, std::string_view key) {
  const auto values = law.values();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (const auto* value = std::get_if<Type>(&values[i]); value && law.parameters()[i].key == key) return *value;
  return std::nullopt;
}

/// The first of those keys that is a number, or the sum of a list.
std::optional<double> first_of(const Element& law, std::initializer_list<std::string_view> keys) {
  for (const auto key : keys) {
    if (const auto number = law.number(key)) return number;
    if (const auto list = value_of<std::vector<double>>(law, key))
      return std::accumulate(list->begin(), list->end(), 0.0);
  }
  return std::nullopt;
}

Traits traits_of(const Element& law) {
  Traits t;
  t.Fc = first_of(law, {"Fc", "W"});
  t.Fs = law.number("Fs") ? law.number("Fs") : t.Fc;
  t.Fs_minus = law.number("Fs_minus");
  t.Fc_minus = law.number("Fc_minus");
  t.vs = law.number("vs");
  t.sigma0 = first_of(law, {"sigma0", "ks", "k", "K"});
  if (!t.sigma0 && t.Fs)
    if (const auto range = first_of(law, {"Zb", "s"})) t.sigma0 = *t.Fs / *range;
  t.sigma1 = first_of(law, {"sigma1", "B", "sigma"});
  t.delta = law.number("delta").value_or(2.0);
  t.sigma2 = law.number("sigma2").value_or(0.0);
  t.vd = law.number("vd").value_or(0.0);
  if (t.vs) t.curve = value_of<Choice>(law, "curve").value_or(Choice{});
  if (const auto ratio = law.number("zba_ratio")) {
    t.zba_ratio = *ratio;
    t.zba_of = value_of<Choice>(law, "zba_of").value_or(Choice{});
  }
  return t;
}

/// Builds a rung, or the reason why there is none.
class Builder {
 public:
  explicit Builder(const Traits& traits) : t_(traits) {}

  SimplifiedLaw coulomb(bool stiction) const {
    SimplifiedLaw rung{stiction ? "coulomb + stiction" : "coulomb", {}, {}};
    if (missing(rung, {&t_.Fc})) return rung;
    Coulomb<double> law;
    set_levels(law, stiction);
    law.sigma2 = t_.sigma2;
    rung.law = law;
    rung.rule = stiction ? "same Fs, Fc, sigma2; no Stribeck curve, no bristles" : "same Fc, sigma2; Fs = Fc";
    return rung;
  }
  SimplifiedLaw stribeck() const {
    SimplifiedLaw rung{"stribeck", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.vs})) return rung;
    Stribeck<double> law;
    set_curve(law);
    law.sigma2 = t_.sigma2;
    rung.law = law;
    rung.rule = "same Fs, Fc, vs, delta, curve, sigma2; no bristles";
    return rung;
  }
  SimplifiedLaw dahl() const {
    SimplifiedLaw rung{"dahl", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.sigma0})) return rung;
    Dahl<double> law;
    law.Fc = *t_.Fc;
    law.sigma0 = *t_.sigma0;
    rung.law = law;
    rung.rule = "same Fc, sigma0, exponent 1; Fs, the Stribeck curve, sigma1 and sigma2 dropped";
    return rung;
  }
  SimplifiedLaw lugre() const {
    SimplifiedLaw rung{"lugre", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.vs, &t_.sigma0})) return rung;
    LuGre<double> law;
    set_bristles(law);
    rung.law = law;
    rung.rule = "same levels, curve, sigma0, sigma1, sigma2";
    return rung;
  }
  SimplifiedLaw elasto_plastic() const {
    SimplifiedLaw rung{"elasto-plastic", {}, {}};
    if (missing(rung, {&t_.Fc, &t_.vs, &t_.sigma0})) return rung;
    ElastoPlastic<double> law;
    set_bristles(law);
    law.zba_ratio = t_.zba_ratio;
    law.zba_of = t_.zba_of;
    rung.law = law;
    rung.rule = "as lugre, elastic up to zba_ratio = " + short_number(t_.zba_ratio) + " of the steady deflection";
    return rung;
  }
  SimplifiedLaw multi_state() const {
    SimplifiedLaw rung{"multi-state", {}, {}};
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
  SimplifiedLaw non_drift() const {
    SimplifiedLaw rung{"non-drift", {}, {}};
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
  bool missing(SimplifiedLaw& rung, std::initializer_list<const std::optional<double>*> needed) const {
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

/// The rung of the law itself; the number of rungs if it is on none.
std::size_t own_rung(const Element& own) {
  if (const auto* law = own.as<Coulomb<double>>()) return law->Fs > law->Fc || law->Fs_minus > law->Fc_minus ? 1 : 0;
  constexpr std::string_view kinds[] = {"", "", "stribeck", "dahl", "lugre", "elasto-plastic", "", "non-drift"};
  const Element* known = find_kind(catalogue_of_elements().friction_laws, own.kind());
  if (known == nullptr || !known->is_of_kind_of(own)) return std::size(kinds);  // a user-defined law, whatever its name
  for (const auto multi : {"gms", "maxwell-slip", "leuven", "iwan", "xiong"})
    if (own.kind() == multi) return 6;
  return static_cast<std::size_t>(std::ranges::find(kinds, own.kind()) - std::begin(kinds));
}

/// The law with parameter number `chosen`, and those that depend on it, times a factor.
Element scaled(const Element& law, std::size_t chosen, double factor) {
  auto values = law.values();
  const ParameterValue before = values[chosen];
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i == chosen || (law.parameters()[i].default_from == law.parameters()[chosen].key && values[i] == before))
      std::get<double>(values[i]) *= factor;
  return law.with(values);
}

}  // namespace

std::vector<SimplifiedLaw> simplified_laws(const Element& own) {
  const Builder build(traits_of(own));
  std::vector<SimplifiedLaw> ladder{build.coulomb(false), build.coulomb(true), build.stribeck(),
                                    build.dahl(),         build.lugre(),       build.elasto_plastic(),
                                    build.multi_state(),  build.non_drift()};
  const std::size_t at = own_rung(own);
  if (at >= ladder.size()) ladder.push_back({std::string(own.kind()), {}, {}});
  SimplifiedLaw& rung = ladder[std::min(at, ladder.size() - 1)];
  if (rung.name == "multi-state") rung.name = own.kind();
  rung.law = own;
  rung.rule = "the case's own law";
  rung.own = true;
  return ladder;
}

std::vector<LawVariation> law_variations(const Element& own, double spread) {
  std::vector<LawVariation> list;
  const auto values = own.values();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const ParameterRow& row = own.parameters()[i];
    const auto* number = std::get_if<double>(&values[i]);
    if (number == nullptr || *number == 0.0 || !std::isfinite(*number)) continue;
    if (const auto source = own.number(row.default_from); source && *source == *number) continue;
    for (const double sign : {-1.0, 1.0}) {
      const Element law = scaled(own, i, 1.0 + sign * spread);
      if (law.validate() || !row.range.contains(*law.number(row.key))) continue;
      list.push_back({std::string(row.key) + (sign < 0.0 ? " -" : " +") + short_number(100.0 * spread) + " %", law});
    }
  }
  return list;
}

}  // namespace limcycle
