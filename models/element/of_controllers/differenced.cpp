#include "limcycle/models/element/of_controllers/differenced.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace limcycle {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The stated size if there is one, else that of the value, else 1.
double size_of(double stated, double value) {
  if (std::isfinite(stated) && stated > 0.0) return stated;
  return value != 0.0 && std::isfinite(value) ? std::abs(value) : 1.0;
}

/// Evaluates `asked` on double at a point and adds its derivatives by differences. `asked` reads the input and the
/// states, and writes its results.
template <class S, class Asked>
void difference(const ElementFace& law, const Input<S>& in, std::span<const S> z, std::span<S> out,
                const Asked& asked) {
  Input<double> at{value_of(in.x), value_of(in.v), value_of(in.drive)};
  std::vector<double> own, up(out.size()), down(out.size());
  z = z.first(std::min(static_cast<std::size_t>(law.states()), z.size()));
  own.reserve(z.size());
  for (const S& state : z) own.push_back(value_of(state));
  asked(at, std::span<const double>(own), std::span<double>(up));
  std::ranges::copy(up, out.begin());
  const auto along = [&](const S& seeded, double& variable, double h) {
    if (is_constant(seeded)) return;
    const double middle = variable, right = middle + h, left = middle - h;
    variable = right;
    asked(at, std::span<const double>(own), std::span<double>(up));
    variable = left;
    asked(at, std::span<const double>(own), std::span<double>(down));
    variable = middle;
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = out[i] + (up[i] - down[i]) / (right - left) * (seeded - middle);
  };
  const double third = std::cbrt(epsilon);
  const Scales scales = law.scales();
  along(in.x, at.x, third * size_of(scales.displacement, at.x) + std::sqrt(epsilon) * std::abs(at.x));
  along(in.v, at.v, third * std::max(std::abs(at.v), size_of(scales.velocity, at.v)));
  if (std::isfinite(at.drive)) along(in.drive, at.drive, third * std::max(std::abs(at.drive), scales.output));
  for (std::size_t i = 0; i < own.size(); ++i)
    along(z[i], own[i], third * std::max(std::abs(own[i]), law.state_scale(static_cast<int>(i))));
}

}  // namespace

template <class S>
S Differenced<S>::output(const Input<S>& in, Mode mode, std::span<const S> z) const {
  return respond(in, mode, z, {});
}

template <class S>
void Differenced<S>::rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
  difference(*law_, in, z, dz.first(static_cast<std::size_t>(law_->states())),
             [&](const Input<double>& at, auto own, std::span<double> out) { law_->rate(at, mode, own, out); });
}

template <class S>
S Differenced<S>::respond(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
  S force[1];
  difference(*law_, in, z, std::span<S>(force),
             [&](const Input<double>& at, auto own, std::span<double> out) { out[0] = law_->output(at, mode, own); });
  if (!dz.empty()) rate(in, mode, z, dz);
  return force[0];
}

template <class S>
void Differenced<S>::guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
  difference(*law_, in, z, g.first(static_cast<std::size_t>(law_->guards(mode))),
             [&](const Input<double>& at, auto own, std::span<double> out) { law_->guard(at, mode, own, out); });
}

template <class S>
Mode Differenced<S>::next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const {
  const auto count = static_cast<std::size_t>(law_->states());
  const std::vector<S> before(z.begin(), z.begin() + law_->states());
  Mode after = mode;
  bool first = true;  // the point itself: its neighbours give derivatives only
  difference(*law_, in, std::span<const S>(before), z.first(count),
             [&](const Input<double>& at, auto own, std::span<double> out) {
               std::ranges::copy(own, out.begin());
               const Mode reached = law_->next(at, mode, out, fired);
               if (std::exchange(first, false)) after = reached;
             });
  return after;
}

template <class S>
S Differenced<S>::storage(Mode mode, std::span<const S> z) const {
  S energy[1];
  difference(*law_, Input<S>{}, z, std::span<S>(energy),
             [&](const Input<double>&, auto own, std::span<double> out) { out[0] = law_->storage(mode, own); });
  return energy[0];
}

template class Differenced<Dual<1>>;
template class Differenced<Dual<4>>;

}  // namespace limcycle
