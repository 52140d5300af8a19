#include "limcycle/analysis/energy/loop/rubbing_impedance.hpp"

#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Row = Eigen::RowVectorXd;

/// True if a = b up to rounding of the terms.
bool same(const Row& a, const Row& b, const Row& size) {
  return ((a - b).cwiseAbs().array() <= 1e-12 * size.cwiseAbs().array() + 1e-300).all();
}

/// True if v = C_v X is the rate of the displacement C X, for any state, and without external input.
bool is_rate_of_displacement(const Loop& loop, const Port& port) {
  const Row size = port.C.cwiseAbs() * loop.A.cwiseAbs() + port.C_v.cwiseAbs();
  const double reach = (port.C * loop.B.rightCols(1)).norm();
  const double outside = std::abs((port.C * loop.E * loop.external).value());
  return same(port.C * loop.A, port.C_v, size) && reach <= 1e-12 * port.C.norm() * loop.B.rightCols(1).norm() &&
         outside <= 1e-12 * port.C.norm() * (loop.E.cwiseAbs() * loop.external.cwiseAbs()).norm();
}

/// True if there is a direction of the state that changes only the displacement, without effect on the loop.
bool displacement_is_free(const Loop& loop, const Port& port) {
  const Index n = loop.states();
  const MatrixXd kernel = MatrixXd::Identity(n, n) - pseudo_inverse(loop.A) * loop.A;
  return (port.C * kernel).norm() > 1e-9 * port.C.norm();
}

std::string at_frequency(const RealPart& real) {
  const RealPart::Least& least = real.least();
  if (real.constant()) return "at every w";
  if (least.frequency == 0.0) return "as w goes to 0";
  if (std::isinf(least.frequency)) return "as w goes to infinity";
  return "at w = " + short_number(least.frequency) + " rad/s";
}

}  // namespace

RubbingImpedance::RubbingImpedance(const Loop& loop) { applies_ = check(loop); }

/// Checks that the theorem applies to this loop; makes the impedance if so.
Answer RubbingImpedance::check(const Loop& loop) {
  const auto not_applicable = [](std::string why) { return Answer{Decision::not_applicable, std::move(why)}; };
  if (loop.ports.empty() || !loop.ports.back().opposes) return not_applicable("there is no friction in the loop");
  if (loop.elements.size() > 1) return not_applicable("the rest of the loop is not linear: " + loop.ports.front().path);
  if (loop.delay > 0.0) return {Decision::undecided, "the rest of the loop has a delay, so that it is not rational"};
  const Port& port = loop.ports.back();
  if (std::abs(port.c_v.dot(loop.external.transpose())) > 0.0)
    return not_applicable(
        "the body rubs at a mean velocity (belt or shaft): passivity is not about deviations from it");
  if (!is_rate_of_displacement(loop, port))
    return not_applicable("the rubbing velocity may have a mean value (ramp, or a velocity port of its own)");
  const bool still = (loop.E * loop.external).isZero(0.0);
  needs_zero_frequency_ = displacement_is_free(loop, port);
  if (needs_zero_frequency_ && !still)
    return not_applicable("a constant force may keep the body sliding: nothing holds its position");
  const Minimal H = minimal({loop.A, loop.B, -port.C_v, MatrixXd::Zero(1, 1)});
  const double size = loop.A.norm();
  for (const std::complex<double> s : H.hidden)
    if (std::abs(s.real()) <= 1e-9 * size && std::abs(s.imag()) > 1e-9 * size) free_mode_ = true;
  const auto Z = inverse(H.H);
  if (!Z)
    return {Decision::undecided,
            "force and velocity are more than one integration apart, so that the impedance grows "
            "faster than that of a mass"};
  if (!(Z->slope > 0.0)) return not_applicable("friction pushes forwards: its force drives its own velocity");
  real_.emplace(Z->proper, Z->made_of.A, Z->made_of.D);
  return {Decision::yes, "one friction law against a linear rest"};
}

PositiveReal RubbingImpedance::rest_is_passive() const {
  if (!real_) return {applies_, false};
  return positive_real(*real_);
}

Answer RubbingImpedance::no_cycle(double deficit) const {
  if (!real_) return applies_;
  if (std::isnan(deficit)) return {Decision::undecided, "it is not known how much the law lacks to be passive"};
  const RealPart::Least least = real_->least();
  const std::string size = least.value == -infinite
                               ? "falls without bound ("
                               : "is " +
                                     std::string(std::isfinite(least.error) ? "" : "not known for certain, about ") +
                                     short_number(least.value) + " N s/m" + (real_->constant() ? " (" : " at least (");
  const std::string numbers = "the resistance Re Z(jw) of the rest " + size + at_frequency(*real_) + "), the law " +
                              (deficit > 0.0   ? "lacks " + short_number(deficit) + " N s/m to be passive"
                               : deficit < 0.0 ? "is passive with " + short_number(-deficit) + " N s/m to spare"
                                               : "is passive");
  if (free_mode_)
    return {Decision::no, "not proved: the rest has an undamped mode that friction does not feel; " + numbers};
  if (!real_->axis_poles().empty())
    return {Decision::no, "not proved: at " + short_number(real_->axis_poles().front()) +
                              " rad/s the rest may swing undamped, to rounding, while the rubbing body stands still; " +
                              numbers};
  const Decision above = real_->above(deficit);
  const bool at_zero_too = !needs_zero_frequency_ || real_->origin().order > 0 || real_->above_at_zero(deficit);
  if (above == Decision::yes && at_zero_too) return {Decision::yes, "proved: " + numbers};
  if (above == Decision::yes)
    return {Decision::no, "not proved: the body may drift, and Re Z(0) is not above what the law lacks; " + numbers};
  if (above == Decision::no) return {Decision::no, "not proved: " + numbers};
  return {Decision::undecided, "undecided, the two being equal to rounding: " + numbers};
}

}  // namespace limcycle
