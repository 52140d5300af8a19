#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/claims/describing_functions/gain_claim.hpp"
#include "limcycle/analysis/study/claims/friction/driven_law.hpp"
#include "limcycle/analysis/study/claims/friction/friction_claims.hpp"
#include "limcycle/models/catalogue.hpp"

namespace limcycle {
namespace {

constexpr std::array rate_independent{"dahl", "bouc-wen", "jenkins", "maxwell-slip", "iwan", "coulomb"};

/// N at two frequencies.
void check_frequency(ClaimChecks& checks, const std::string& label, double A, double w) {
  const auto law = make_law(compared_setting(label));
  const auto slow = computed_gain(law, {A, 1.0, 0.0}, false, 1e-9), fast = computed_gain(law, {A, w, 0.0}, false, 1e-9);
  if (!slow.answered() || !fast.answered()) return checks.stop(slow.answered() ? fast.status : slow.status);
  checks.equal(label + ", " + place({{"A", A, "m"}, {"w", w, "rad/s"}}), "|N - N(w = 1)| over its size", "", 0.0,
               std::abs(fast.gain - slow.gain) / std::abs(slow.gain), slow.error + fast.error + 1e-12, 1.0);
}

/// The unit of a parameter in this law.
std::string_view unit_of(const std::string& kind, const std::string& key) {
  const Element* law = find_kind(catalogue_of_elements().friction_laws, kind);
  const auto row = std::ranges::find(law->parameters(), key, &ParameterRow::key);
  return row == law->parameters().end() ? std::string_view() : row->unit;
}

/// The law with every parameter that has newtons in its unit times a factor.
LawSetting louder(const LawSetting& setting, double factor) {
  LawSetting scaled = setting;
  for (auto& [key, value] : scaled.values) {
    if (!unit_of(setting.kind, key).starts_with("N")) continue;
    if (auto* number = std::get_if<double>(&value)) *number *= factor;
    if (auto* list = std::get_if<std::vector<double>>(&value))
      for (double& one : *list) one *= factor;
  }
  return scaled;
}

void check_homogeneous(ClaimChecks& checks, const LawSetting& setting, double A, double w, double factor) {
  const DfPoint point{A, w, 0.0};
  const auto one = computed_gain(make_law(setting), point, false, 1e-6);
  const auto scaled = computed_gain(make_law(louder(setting, factor)), point, false, 1e-6);
  if (!one.answered() || !scaled.answered()) return;  // no periodic state, or a law that needs the applied force
  checks.equal(setting.label + ", " + place({{"A", A, "m"}, {"w", w, "rad/s"}, {"factor", factor}}),
               "|N of the scaled law - factor N| over its size", "", 0.0,
               std::abs(scaled.gain - factor * one.gain) / (factor * std::abs(one.gain)),
               one.error + scaled.error + 1e-10, 1.0);
}

/// The force of a rate-independent law at the end of a path depends only on its turning points.
void check_reparametrised(ClaimChecks& checks, const std::string& label, RandomPoints& random) {
  const auto law = make_law(compared_setting(label));
  DrivenLaw even(law), uneven(law);
  double sign = 1.0;
  for (int k = 0; k < 5; ++k) {
    const double way = random.log_between(3e-6, 1e-3), T = random.log_between(1e-2, 1e2);
    const int steps = 400;
    even.slide(sign, way, steps);
    uneven.go([=](double t) { return sign * way / T * (1.0 + 0.9 * std::cos(2.0 * std::numbers::pi * t / T)); }, T,
              steps);
    sign = -sign;
  }
  checks.equal(label + ", random path of five strokes", "force at another timing", "N", even.force(), uneven.force(),
               1e-5, 1.5);
}

/// Masing: a branch after a reversal is the virgin curve doubled; wiping out: beyond an old reversal the branch is the
/// old one.
void check_masing(ClaimChecks& checks, double way, double back) {
  const auto law = make_law(compared_setting("maxwell-slip"));
  const std::string at = place({{"way", way, "m"}, {"back", back, "m"}});
  DrivenLaw virgin(law), branch(law);
  virgin.slide(1.0, 0.5 * back, 400);
  branch.slide(1.0, way, 400);
  const double turned = branch.force();
  branch.slide(-1.0, back, 400);
  checks.equal(at, "fall of F since the reversal, twice the virgin curve at half the way", "N", 2.0 * virgin.force(),
               turned - branch.force(), 1e-12, 1.5);
  // Beyond the reversal the virgin curve continues as if it had not been interrupted.
  branch.slide(1.0, 1.5 * back, 400);
  DrivenLaw straight(law);
  straight.slide(1.0, way + 0.5 * back, 400);
  checks.equal(at, "F beyond a closed loop, that of the path without it", "N", straight.force(), branch.force(), 1e-12,
               1.5);
}

ClaimResult test_scales(const ClaimOptions& options) {
  ClaimChecks checks;
  for (const char* label : rate_independent) check_frequency(checks, label, 1e-4, 50.0);
  check_masing(checks, 1e-4, 5e-5);
  RandomPoints random(options.seed);
  for (const char* label : {"dahl", "jenkins", "maxwell-slip", "iwan"}) check_reparametrised(checks, label, random);
  checks.random(true);
  for (int i = 0; i < options.random_points && !stopped(options); ++i) {
    const char* label = rate_independent[static_cast<std::size_t>(i) % rate_independent.size()];
    const double A = random.log_between(1e-6, 1e-2), w = random.log_between(1e-2, 1e3),
                 way = random.log_between(1e-5, 1e-3);
    check_frequency(checks, label, A, w);
    check_masing(checks, way, way * random.between(0.05, 1.9));
    check_reparametrised(checks, i % 2 == 0 ? "iwan" : "maxwell-slip", random);
    const auto& laws = law_settings();
    const double swing = random.log_between(1e-6, 1e-2), frequency = random.log_between(0.1, 100.0);
    check_homogeneous(checks, laws[static_cast<std::size_t>(i) % laws.size()], swing, frequency,
                      random.log_between(0.1, 10.0));
  }
  if (stopped(options)) checks.stop(Status::interrupted);
  return checks.result();
}

}  // namespace

std::vector<Claim> friction_scale_claims() {
  return {
      {"D11",
       "Scale laws: the describing function of a rate-independent law does not depend on the frequency, its force not "
       "on the timing along a path; every law is homogeneous of degree 1 in its forces, stiffnesses and dampings; "
       "Maxwell-slip obeys Masing's rule and wiping-out exactly.",
       "N(A, w) = N(A); F(c Fs, c Fc, c sigma, ...) = c F; F_r - F(x_r - d) = 2 f_v(d/2)", "derived", Evidence::derived,
       "the laws that the experiments compare; A 1e-6 to 0.01 m, w 0.01 to 1000 rad/s, factors 0.1 to 10",
       "describing functions by quadrature; laws marched along random paths at two timings", ClaimVerdict::holds,
       test_scales}};
}

}  // namespace limcycle
