#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {
namespace {

/// Results of a law at one point: its force and the rates of its states.
struct SaidByLaw {
  std::vector<double> values;
  SaidByLaw(const ElementFace& law, const Input<double>& in, Mode mode, const std::vector<double>& z)
      : values(1 + z.size()) {
    values[0] = law.output(in, mode, z);
    law.rate(in, mode, z, std::span(values).subspan(1));
  }
};

[[noreturn]] void refuse_law(const ElementFace& law, const std::string& why) {
  throw std::invalid_argument(std::string(law.facts().kind) + ": " + why);
}

void check_sizes(const ElementFace& law) {
  const Scales scales = law.scales();
  if (!(scales.displacement > 0.0 && scales.velocity > 0.0))
    refuse_law(law, "scales() must be positive (infinite: there is no such size)");
  if (!(scales.output > 0.0 && std::isfinite(scales.output)))
    refuse_law(law, "scales().output must be positive and finite");
  if (law.states() < 0) refuse_law(law, "states() must not be negative");
  for (int i = 0; i < law.states(); ++i)
    if (const double size = law.state_scale(i); !(size > 0.0 && std::isfinite(size)))
      refuse_law(law, "state_scale(" + std::to_string(i) +
                          ") must be positive and finite; where it is left out, so must scales().displacement");
}

/// True if the results for the mirrored motion are the mirror image, to rounding. NaN proves nothing.
bool mirrors(const ElementFace& law, const SaidByLaw& here, const SaidByLaw& there) {
  double size = law.scales().output;
  for (std::size_t i = 0; i < here.values.size(); ++i) {
    const bool even = i > 0 && law.even_state(static_cast<int>(i) - 1);
    const double off = even ? there.values[i] - here.values[i] : there.values[i] + here.values[i];
    if (i > 0) size = std::max(std::abs(here.values[i]), std::abs(there.values[i]));
    if (std::abs(off) > 1e-9 * std::max(size, std::abs(here.values[i]))) return false;
  }
  return true;
}

}  // namespace

bool tried_for_position(const ElementFace& law) {
  check_sizes(law);
  bool depends_on_position = false;
  std::mt19937 random(1);
  const auto between = [&random](double low, double high) {  // the same numbers with every standard library
    return low + (high - low) * (static_cast<double>(random()) / 4294967295.0);
  };
  const Scales scales = law.scales();
  const double speed = std::isfinite(scales.velocity) ? scales.velocity : 1.0;
  const double way = std::isfinite(scales.displacement) ? scales.displacement : 1.0;
  for (int point = 0; point < 48; ++point) {
    Input<double> in{0.0, speed * std::pow(10.0, between(-3.0, 1.47)), 0.0};
    std::vector<double> z(static_cast<std::size_t>(law.states()), 0.0);
    const Mode mode = law.start(in, z);
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double size = law.state_scale(static_cast<int>(i));
      if (law.guards(mode) == 0) z[i] = between(law.even_state(static_cast<int>(i)) ? 0.0 : -size, size);
    }
    const SaidByLaw here(law, in, mode, z);
    for (const double moved : {0.37 * way, 51.3 * way}) {
      const SaidByLaw there(law, {moved, in.v, 0.0}, mode, z);
      for (std::size_t i = 0; i < here.values.size(); ++i)
        depends_on_position |= std::isfinite(here.values[i]) && there.values[i] != here.values[i];
    }
    if (!law.odd()) continue;
    std::vector<double> mirrored(z);
    for (std::size_t i = 0; i < z.size(); ++i)
      if (!law.even_state(static_cast<int>(i))) mirrored[i] = -z[i];
    if (!mirrors(law, here, SaidByLaw(law, {-in.x, -in.v, 0.0}, law.mirror(mode), mirrored)))
      refuse_law(law, "odd() returns true, but the force or a rate does not change its sign with v = " +
                          std::to_string(in.v) + " and the states");
  }
  return depends_on_position;
}

}  // namespace limcycle
