#pragma once
#include <algorithm>
#include <array>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "limcycle/models/element/element.hpp"
#include "limcycle/tests/share.hpp"

/// Parameter sets of every friction law, with the properties that the conformance tests check. A law in the list
/// `FrictionLaws` without samples here does not compile.
namespace limcycle::test {

using Setting = std::variant<double, std::vector<double>, std::string>;
using Settings = std::vector<std::pair<std::string_view, Setting>>;

/// One parameter set and its claims.
struct Sample {
  std::string_view name;
  Settings settings;
  double level = 0.0;             ///< |F| <= level + per_speed |v| + per_way |x|
  double per_speed = 0.0;         ///< N s/m
  double per_way = 0.0;           ///< N/m
  bool passive = false;           ///< no work can be extracted from the unloaded law, at any speed
  bool rate_independent = false;  ///< the force is a function of the path alone
  double fastest = infinite;      ///< s, shortest own time constant
  double slowest = 0.0;           ///< s, longest own time constant
  double settles = 40.0;          ///< path of steady sliding after which it is steady, in Scales::displacement
  double steady = nothing;        ///< N, level of steady sliding of a law without a Stribeck curve; `nothing`: none
  bool sustained = true;          ///< with a mean velocity too a periodic state is reached in finite time
  bool is_steady = true;          ///< at constant speed the force becomes constant
  double closes = nothing;        ///< relative gap of a closed slow minor loop; `nothing`: it does not close
  double holds_below = 0.0;       ///< N, a periodic force below that causes no drift; 0: it drifts
  double wobbles = 1e-12;         ///< m, largest displacement per cycle that counts as none
  /// With a slow drift (two-point memory: in sliding too) the periodic state takes more periods than are searched: the
  /// describing function may end without an answer, and must state it.
  bool settles_slowly = false;
  static constexpr double nothing = std::numeric_limits<double>::infinity();
};

/// A law with these parameters; the others have their defaults. Throws std::invalid_argument for an unknown key, a
/// missing or an invalid value.
template <class Law>
Law made(const Settings& settings) {
  Law law{};
  std::vector<std::string_view> given;
  const auto table = Law::parameters();
  const auto row_of = [&](std::string_view key) {
    const auto row = std::ranges::find(table, key, [](const auto& parameter) { return parameter.key; });
    if (row == table.end()) throw std::invalid_argument(std::string(Law::kind) + " has no key " + std::string(key));
    return row;
  };
  for (const auto& [key, value] : settings) {
    const auto row = row_of(key);
    given.push_back(key);
    if (const auto* number = std::get_if<double Law::*>(&row->member)) {
      law.*(*number) = std::get<double>(value);
    } else if (const auto* list = std::get_if<std::vector<double> Law::*>(&row->member)) {
      law.*(*list) = std::get<std::vector<double>>(value);
    } else {
      const auto name = std::ranges::find(row->choices, std::string_view(std::get<std::string>(value)));
      if (name == row->choices.end()) throw std::invalid_argument("no choice " + std::get<std::string>(value));
      law.*std::get<Choice Law::*>(row->member) = Choice{static_cast<int>(name - row->choices.begin())};
    }
  }
  for (const auto& parameter : table) {
    if (std::ranges::find(given, parameter.key) != given.end()) continue;
    if (!parameter.default_from.empty())
      std::visit(
          [&](auto member) { law.*member = law.*std::get<decltype(member)>(row_of(parameter.default_from)->member); },
          parameter.member);
    else if (parameter.required)
      throw std::invalid_argument(std::string(Law::kind) + " needs " + std::string(parameter.key));
  }
  if (const auto broken = law.validate()) throw std::invalid_argument(broken->key + ": " + broken->rule);
  return law;
}

/// `base` followed by further settings.
inline Settings with(Settings base, std::initializer_list<Settings::value_type> more) {
  for (const auto& setting : more) {
    std::erase_if(base, [&](const auto& old) { return old.first == setting.first; });
    base.push_back(setting);
  }
  return base;
}

// The values of the source documents.
inline const Settings levels{{"Fs", 1.5}, {"Fc", 1.0}};
inline const Settings stribeck_set = with(levels, {{"vs", 1e-3}});
inline const Settings uneven = with(stribeck_set, {{"Fs_minus", 1.2}, {"Fc_minus", 0.8}});
inline const Settings bristle = with(stribeck_set, {{"sigma0", 1e5}});
inline const double root = 316.22776601683796;  // sqrt(1e5) N s/m
inline const Settings four_stops{{"k", std::vector<double>{4e4, 2e4, 1e4, 5e3}},
                                 {"W", std::vector<double>{0.3, 0.4, 0.4, 0.5}}};
inline const Settings measured{{"Fs", 1.5},
                               {"velocities", std::vector<double>{5e-4, 1e-3, 2e-3, 5e-3, 0.02}},
                               {"forces", std::vector<double>{1.35, 1.2, 1.05, 1.0, 1.04}}};
inline const Settings three_blocks =
    with(stribeck_set, {{"k", std::vector<double>{4e4, 2e4, 1e4}}, {"alpha", std::vector<double>{0.5, 0.3, 0.2}}});

/// Samples of the law of that kind; empty: none.
inline std::vector<Sample> samples_of_kind(std::string_view kind) {
  constexpr double exact = 1e-12;
  if (kind == "coulomb")
    return {{.name = "stiction",
             .settings = levels,
             .level = 1.5,
             .passive = true,
             .rate_independent = true,
             .steady = 1.0,
             .holds_below = 1.5},
            {.name = "viscous",
             .settings = with(levels, {{"sigma2", 0.3}}),
             .level = 1.5,
             .per_speed = 0.3,
             .passive = true,
             .steady = 1.0,
             .holds_below = 1.5},
            {.name = "uneven",
             .settings = with(levels, {{"Fs_minus", 1.2}, {"Fc_minus", 0.8}}),
             .level = 1.5,
             .passive = true,
             .rate_independent = true,
             .is_steady = false,
             .holds_below = 1.2}};
  if (kind == "stribeck")
    return {{.name = "thesis", .settings = stribeck_set, .level = 1.5, .passive = true, .holds_below = 1.5},
            {.name = "lorentzian",
             .settings = with(stribeck_set, {{"curve", "lorentzian"}, {"sigma2", 0.4}}),
             .level = 1.5,
             .per_speed = 0.4,
             .passive = true,
             .holds_below = 1.5},
            {.name = "uneven", .settings = uneven, .level = 1.5, .passive = true, .holds_below = 1.2}};
  if (kind == "karnopp" || kind == "quinn" || kind == "awrejcewicz") {
    const bool passive = kind == "karnopp";  // in the band the others have the sign of the applied force
    return {{.name = "thesis",
             .settings = with(stribeck_set, {{"dv", 1e-5}}),
             .level = 1.5,
             .passive = passive,
             .holds_below = 1.0},
            {.name = "wide band",
             .settings = with(stribeck_set, {{"dv", 1e-4}, {"sigma2", 0.4}}),
             .level = 1.5,
             .per_speed = 0.4,
             .passive = passive,
             .holds_below = 1.0}};
  }
  if (kind == "wojewoda")
    return {{.name = "thesis",
             .settings = with(stribeck_set, {{"ks", 1e5}}),
             .level = 1.5,
             .passive = true,
             .is_steady = false,
             .holds_below = 1.0},
            {.name = "viscous",
             .settings = with(stribeck_set, {{"ks", 1e4}, {"sigma2", 0.4}}),
             .level = 1.5,
             .per_speed = 0.4,
             .passive = true,
             .is_steady = false,
             .holds_below = 1.0}};
  if (kind == "kikuuwe")
    return {{.name = "thesis",
             .settings = with(stribeck_set, {{"K", 1e5}, {"B", root}}),
             .level = 1.5,
             .passive = true,
             .fastest = 3e-3,
             .slowest = 3.2e-3,
             .holds_below = 1.0},
            {.name = "viscous",
             .settings = with(stribeck_set, {{"K", 1e4}, {"B", 10.0}, {"sigma2", 0.4}}),
             .level = 1.5,
             .per_speed = 0.4,
             .passive = true,
             .fastest = 1e-3,
             .slowest = 1e-3,
             .holds_below = 1.0}};
  if (kind == "dahl")
    return {{.name = "brittle",
             .settings = {{"Fc", 1.0}, {"sigma0", 1e5}},
             .level = 1.0,
             .passive = true,
             .rate_independent = true,
             .steady = 1.0},
            {.name = "exponent 1.5",
             .settings = {{"Fc", 1.0}, {"sigma0", 1e5}, {"exponent", 1.5}},
             .level = 1.0,
             .passive = true,
             .rate_independent = true,
             .is_steady = false},
            {.name = "exponent 2",
             .settings = {{"Fc", 2.0}, {"sigma0", 1e4}, {"exponent", 2.0}},
             .level = 2.0,
             .passive = true,
             .rate_independent = true,
             .is_steady = false}};
  if (kind == "bouc-wen") {
    const Settings plain{{"k", 1e5}, {"D", 1e-5}, {"beta", 0.5}, {"gamma", 0.5}};
    return {{.name = "even", .settings = plain, .level = 1.0, .passive = true, .rate_independent = true, .steady = 1.0},
            {.name = "as dahl",
             .settings = with(plain, {{"beta", 1.0}, {"gamma", 0.0}}),
             .level = 1.0,
             .passive = true,
             .rate_independent = true,
             .steady = 1.0},
            {.name = "with a spring",
             .settings = with(plain, {{"alpha", 0.1}, {"n", 2.0}, {"beta", 0.9}, {"gamma", 0.1}}),
             .level = 0.9,
             .per_way = 1e4,
             .passive = true,
             .rate_independent = true,
             .sustained = false,
             .is_steady = false},
            {.name = "beyond the condition",
             .settings = with(plain, {{"n", 1.5}, {"beta", 0.25}, {"gamma", 0.75}}),
             .level = 1.0,
             .passive = true,
             .rate_independent = true,
             .steady = 1.0}};
  }
  if (kind == "stribeck-table")
    return {{.name = "measured", .settings = measured, .level = 1.5, .passive = true, .holds_below = 1.5},
            {.name = "uneven",
             .settings = with(measured, {{"Fs_minus", 1.3},
                                         {"velocities_minus", std::vector<double>{6e-4, 1e-3, 4e-3, 0.01}},
                                         {"forces_minus", std::vector<double>{1.2, 1.1, 0.95, 0.9}}}),
             .level = 1.5,
             .passive = true,
             .holds_below = 1.3}};
  if (kind == "lugre-table") {
    const Settings on_bristle = with(measured, {{"sigma0", 1e5}});
    return {{.name = "without damping", .settings = on_bristle, .level = 1.5, .passive = true},
            {.name = "damped",
             .settings = with(on_bristle, {{"sigma1", root}, {"sigma2", 0.4}}),
             .level = 1.5,
             .per_speed = 2.5 * root + 0.4}};
  }
  if (kind == "lugre")
    return {{.name = "1995",
             .settings = with(bristle, {{"sigma1", root}, {"sigma2", 0.4}}),
             .level = 1.5,
             .per_speed = 2.5 * root + 0.4},
            {.name = "without damping", .settings = bristle, .level = 1.5, .passive = true},
            {.name = "passive",
             .settings = with(bristle, {{"sigma1", root}, {"sigma2", 158.2}}),
             .level = 1.5,
             .per_speed = 2.5 * root + 158.2,
             .passive = true},
            {.name = "fading damping",
             .settings = with(bristle, {{"sigma1", root}, {"vd", 2e-3}}),
             .level = 1.5,
             .per_speed = 2.5 * root},
            {.name = "uneven",
             .settings = with(uneven, {{"sigma0", 1e5}, {"sigma1", 10.0}}),
             .level = 1.5,
             .per_speed = 10.0 * (1.0 + 1.5 / 0.8)}};
  if (kind == "lugre-spline") {
    const Settings spline{{"velocity", std::vector<double>{0.0, 1e-3, 2e-3, 5e-3, 1e-2}},
                          {"coefficients", std::vector<double>{1.5, 1.45, 1.2, 1.0, 1.05, 1.1, 1.15}},
                          {"sigma0", 1e5}};
    return {{.name = "without damping", .settings = spline, .level = 1.5, .passive = true},
            {.name = "damped",
             .settings = with(spline, {{"sigma1", root}, {"sigma2", 0.4}}),
             .level = 1.5,
             .per_speed = 2.5 * root + 0.4},
            {.name = "passive",
             .settings = with(spline, {{"sigma1", root}, {"sigma2", 158.2}}),
             .level = 1.5,
             .per_speed = 2.5 * root + 158.2,
             .passive = true}};
  }
  if (kind == "elasto-plastic")
    return {{.name = "thesis",
             .settings = with(bristle, {{"sigma1", root}}),
             .level = 1.5,
             .per_speed = 2.5 * root,
             .holds_below = 0.95},
            {.name = "of Fc",
             .settings = with(bristle, {{"zba_of", "coulomb"}, {"sigma2", 0.4}}),
             .level = 1.5,
             .per_speed = 0.4,
             .passive = true,
             .holds_below = 0.65},
            {.name = "passive",
             .settings = with(bristle, {{"sigma1", root}, {"sigma2", 158.2}, {"zba_ratio", 0.4}}),
             .level = 1.5,
             .per_speed = 2.5 * root + 158.2,
             .passive = true,
             .holds_below = 0.55}};
  if (kind == "leuven")
    return {
        {.name = "n 1", .settings = with(stribeck_set, {four_stops[0], four_stops[1]}), .level = 1.6, .settles = 900.0},
        {.name = "n 3, damped",
         .settings = with(stribeck_set, {four_stops[0], four_stops[1], {"n", 3.0}, {"sigma1", 5.0}}),
         .level = 1.6,
         .per_speed = 5.0 * (1.0 + 4.096),
         .settles = 300.0}};
  if (kind == "jenkins")
    return {{.name = "soft",
             .settings = {{"k", 1000.0}, {"Fc", 1.5}},
             .level = 1.5,
             .passive = true,
             .rate_independent = true,
             .steady = 1.5,
             .closes = exact,
             .holds_below = 1.5}};
  if (kind == "maxwell-slip")
    return {{.name = "four",
             .settings = four_stops,
             .level = 1.6,
             .passive = true,
             .rate_independent = true,
             .steady = 1.6,
             .closes = exact,
             .holds_below = 1.6}};
  if (kind == "iwan") {
    const Settings body{{"Fs", 1.5}, {"Zb", 1e-4}};
    const auto sample = [&](std::string_view name, const Settings& more, double steady) {
      Settings all = body;
      all.insert(all.end(), more.begin(), more.end());
      return Sample{.name = name,
                    .settings = all,
                    .level = 1.5,
                    .passive = true,
                    .rate_independent = true,
                    .steady = steady,
                    .sustained = name != "hyperbolic",
                    .is_steady = steady < Sample::nothing,
                    .closes = exact,
                    .holds_below = name == "hyperbolic" ? 1.2 : 1.5};
    };
    return {sample("exponential", {{"curve", "exponential"}}, 1.5),
            sample("hyperbolic", {{"curve", "hyperbolic"}}, Sample::nothing),
            sample("koizumi-shibazaki", {{"curve", "koizumi-shibazaki"}}, 1.5),
            sample("linear", {{"curve", "linear"}}, 1.5),
            sample("seven elements", {{"curve", "koizumi-shibazaki"}, {"elements", 7.0}}, 1.5)};
  }
  if (kind == "gms-table")
    return {{.name = "measured",
             .settings = with(measured, {{"k", std::vector<double>{4e4, 2e4, 1e4}},
                                         {"alpha", std::vector<double>{0.5, 0.3, 0.2}},
                                         {"C", 10.0}}),
             .level = 1.5,
             .fastest = 0.1,
             .slowest = 0.15,
             .closes = exact,
             .holds_below = 1.0,
             .settles_slowly = true}};
  if (kind == "gms")
    return {{.name = "slow",
             .settings = with(three_blocks, {{"C", 10.0}}),
             .level = 1.5,
             .fastest = 0.1,
             .slowest = 0.15,
             .closes = exact,
             .holds_below = 1.0,
             .settles_slowly = true},
            {.name = "fast, damped",
             .settings = with(three_blocks, {{"C", 1000.0}, {"sigma1", std::vector<double>{5.0, 5.0, 5.0}}}),
             .level = 1.75,
             .per_speed = 15.0,
             .fastest = 1e-3,
             .slowest = 1.5e-3,
             .closes = 1e-3,
             .holds_below = 1.0,
             .settles_slowly = true},
            {.name = "level",
             .settings = with(three_blocks, {{"C", 10.0}, {"Fs", 1.0}}),
             .level = 1.0,
             .passive = true,
             .fastest = 0.1,
             .slowest = 0.1,
             .closes = exact,
             .holds_below = 1.0,
             .settles_slowly = true}};
  if (kind == "xiong") {
    std::vector<double> K, lambda, sigma;
    for (int i = 0; i < 10; ++i) {
      K.push_back(1000.0 + 800.0 * i);
      lambda.push_back(0.0955 + 0.001 * i);
      sigma.push_back(5.0 + 2.5 * i);
    }
    const Settings thesis = with(stribeck_set, {{"K", K}, {"lambda", lambda}, {"sigma", sigma}, {"tau", 2e-3}});
    return {{.name = "thesis",
             .settings = thesis,
             .level = 1.5,
             .passive = true,
             .fastest = 2e-3,
             .slowest = 5e-3,
             .closes = 2e-3,
             .holds_below = 1.0,
             .settles_slowly = true},
            {.name = "viscous",
             .settings = with(thesis, {{"sigma2", 0.4}, {"tau", 0.02}}),
             .level = 1.5,
             .per_speed = 0.4,
             .passive = true,
             .fastest = 3e-3,
             .slowest = 0.02,
             .closes = 2e-3,
             .holds_below = 1.0,
             .settles_slowly = true}};
  }
  // A branch stretched from its return point to its target has, with the Koizumi-Shibazaki curve, no stiffness at the
  // target: a periodic force never quite reaches it, and its reversals vary from cycle to cycle (without drift).
  constexpr double short_of_target = 2e-8;
  if (kind == "two-state")
    return {{.name = "short",
             .settings = with(stribeck_set, {{"s", 1e-4}, {"tau", 2e-3}}),
             .level = 1.5,
             .fastest = 2e-3,
             .slowest = 2e-3,
             .closes = 1e-9,
             .holds_below = 1.0,
             .wobbles = short_of_target}};
  if (kind == "non-drift") {
    const Settings thesis = with(stribeck_set, {{"Zb", 1e-4}, {"sigma", root}, {"tau", 2e-3}});
    const auto sample = [&](std::string_view name, std::initializer_list<Settings::value_type> more) {
      return Sample{.name = name,
                    .settings = with(thesis, more),
                    .level = 1.5,
                    .passive = true,
                    .fastest = 2e-3,
                    .slowest = 0.03,
                    .settles = 10.0,
                    .closes = exact,
                    .holds_below = 1.0,
                    .wobbles = name == "two-point" ? short_of_target : 1e-12,
                    .settles_slowly = true};
    };
    return {sample("thesis", {}),
            sample("exponential", {{"branch", "exponential"}}),
            sample("rational", {{"branch", "rational"}}),
            sample("linear", {{"branch", "linear"}}),
            sample("two-point", {{"memory", "two-point"}}),
            sample("two-point, exponential", {{"memory", "two-point"}, {"branch", "exponential"}}),
            sample("no lag", {{"tau", 0.0}})};
  }
  return {};
}

inline constexpr std::array<std::string_view, 23> sampled_kinds{
    "stribeck-table", "lugre-table", "gms-table",    "coulomb",  "stribeck", "karnopp",   "quinn",        "awrejcewicz",
    "wojewoda",       "kikuuwe",     "dahl",         "bouc-wen", "lugre",    "leuven",    "lugre-spline", "iwan",
    "elasto-plastic", "jenkins",     "maxwell-slip", "gms",      "xiong",    "two-state", "non-drift"};

/// Calls visit(law, sample) for each sample of the law.
template <template <class> class Kind>
void for_samples(auto&& visit) {
  static_assert(std::ranges::find(sampled_kinds, Kind<double>::kind) != sampled_kinds.end(),
                "this friction law has no samples: add them, and its name, to tests/friction_samples.hpp");
  const auto samples = samples_of_kind(Kind<double>::kind);
  if (samples.empty()) throw std::logic_error("no samples of " + std::string(Kind<double>::kind));
  for (const Sample& sample : samples) visit(made<Kind<double>>(sample.settings), sample);
}

/// The same with the first sample of each law and, where not everything is done (see share.hpp), only some of the
/// others.
template <template <class> class Kind>
void for_some_samples(auto&& visit) {
  int number = 0;
  for_samples<Kind>([&](const auto& law, const Sample& sample) {
    if (is_done(number++)) visit(law, sample);
  });
}

}  // namespace limcycle::test
