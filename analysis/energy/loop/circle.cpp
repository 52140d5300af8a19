#include "limcycle/analysis/energy/loop/circle.hpp"

#include <cmath>
#include <numbers>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"

namespace limcycle {
namespace {

using Eigen::MatrixXd;

std::string slopes(double alpha, double beta) {
  return "slopes in [" + short_number(alpha) + ", " + (std::isinf(beta) ? "infinity)" : short_number(beta) + "]");
}

}  // namespace

std::optional<std::pair<double, double>> chord_slopes(const Element& element) {
  if (const auto bounds = element.slope_bounds()) return bounds;
  if (const auto* cubic = element.as<Cubic<double>>())
    return cubic->coefficient >= 0.0 ? std::pair(0.0, infinite) : std::pair(-infinite, 0.0);
  return std::nullopt;
}

CircleCriterion::CircleCriterion(const Loop& loop) {
  applies_ = check(loop);
  if (applies_.decision != Decision::yes) {
    circle_answer_ = popov_answer_ = applies_;
    return;
  }
  answer_circle();
  answer_popov(loop);
}

/// Checks that the criteria apply to this loop; makes G' if so.
Answer CircleCriterion::check(const Loop& loop) {
  const auto not_applicable = [](std::string why) { return Answer{Decision::not_applicable, std::move(why)}; };
  if (loop.elements.size() != 1) return not_applicable("the loop has more than one nonlinear element");
  const auto bounds = chord_slopes(loop.elements[0]);
  if (!bounds) {
    const std::string kind(loop.elements[0].kind());
    return not_applicable("the " + kind + " has memory, jumps or acts on a rate: its slopes have no bounds");
  }
  std::tie(alpha_, beta_) = *bounds;
  if (std::isinf(alpha_)) return not_applicable("the slopes of the element are not bounded from below");
  if (loop.delay > 0.0) return {Decision::undecided, "the loop has a delay, so that G is not rational"};
  const Port& port = loop.ports[0];
  if (port.D(0) != 0.0) return not_applicable("the element's output passes straight into its own input");
  inverse_k_ = std::isinf(beta_) ? 0.0 : 1.0 / (beta_ - alpha_);
  const Minimal G = minimal({loop.A + alpha_ * loop.B * port.C, loop.B, -port.C, MatrixXd::Zero(1, 1)});
  G_ = G.H;
  const double size = loop.A.norm();
  for (const std::complex<double> s : G.hidden)
    if (std::abs(s.real()) <= 1e-9 * size && std::abs(s.imag()) > 1e-9 * size) free_mode_ = true;
  return {Decision::yes, "one element with " + slopes(alpha_, beta_)};
}

/// 1/k + (1 + q s) G'(s).
StateSpace CircleCriterion::with_multiplier(double q) const {
  return {G_.A, G_.B, G_.C + q * G_.C * G_.A, MatrixXd::Constant(1, 1, inverse_k_ + q * (G_.C * G_.B).value())};
}

void CircleCriterion::answer_circle() {
  circle_.emplace(with_multiplier(0.0));
  const RealPart::Least& least = circle_->least();
  const std::string numbers = "1/k + Re G is " + short_number(least.value) + " at least, for " + slopes(alpha_, beta_);
  if (free_mode_ || !circle_->axis_poles().empty()) {
    circle_answer_ = {Decision::no, "not proved: the loop swings undamped while the element lets go; " + numbers};
    return;
  }
  const Decision above = circle_->above(0.0);
  circle_answer_ = {above, (above == Decision::yes  ? "proved by the circle criterion: "
                            : above == Decision::no ? "not proved by the circle criterion: "
                                                    : "undecided, zero to rounding: ") +
                               numbers};
}

/// Popov's criterion applies to deviations from an equilibrium, whose harmonic k = 0 counts.
bool CircleCriterion::equilibrium_allows(const Loop& loop) {
  const bool still = (loop.E * loop.external).isZero(0.0) && loop.ports[0].c.dot(loop.external.transpose()) == 0.0;
  if (circle_->origin().order > 0) return still;  // x = 0 is one; psi has no mean
  return circle_->above_at_zero(0.0);             // x + G'(0) psi(x) rises: there is one, and k = 0 is positive
}

void CircleCriterion::answer_popov(const Loop& loop) {
  if (free_mode_ || !circle_->axis_poles().empty()) {
    popov_answer_ = {Decision::no, "not proved: the loop swings undamped while the element lets go"};
    return;
  }
  if (!equilibrium_allows(loop)) {
    popov_answer_ = {Decision::no,
                     "not proved: at w = 0 the condition fails, or a constant signal leaves no equilibrium "
                     "to start from"};
    return;
  }
  search_multiplier();
}

/// q = tan(angle)/rate: each frequency that fails cuts the circle of directions (1, q) in half, so that the possible
/// directions form an arc.
void CircleCriterion::search_multiplier() {
  constexpr double quarter = 0.5 * std::numbers::pi;
  const double rate = G_.A.norm();
  double low = -quarter, high = quarter;
  bool doubtful = false;
  for (int i = 0; i < 200 && high - low > 1e-12; ++i) {
    const double angle = 0.5 * (low + high), q = std::tan(angle) / rate;
    const RealPart part(with_multiplier(q));
    const Decision above = part.above(0.0);
    if (above == Decision::yes) {
      q_ = q;
      popov_answer_ = {Decision::yes,
                       "proved by Popov's criterion with q = " + short_number(q) + " s, for " + slopes(alpha_, beta_)};
      return;
    }
    doubtful = doubtful || above == Decision::undecided;
    const RealPart::Least& least = part.least();
    // 1/k + Re G' - q w Im G' > 0 at this frequency bounds the remaining q.
    const double w = std::isfinite(least.frequency) ? least.frequency : 1e6 * rate;
    const double turn = w > 0.0 ? -w * G_.at({0.0, w})(0, 0).imag() : circle_->origin().residue;
    if (turn == 0.0) break;  // no q changes that
    (turn > 0.0 ? low : high) = angle;
  }
  popov_answer_ = {doubtful ? Decision::undecided : Decision::no,
                   std::string(doubtful ? "undecided: for some q Popov's condition is zero to rounding, for "
                                        : "not proved by Popov's criterion: for every q some frequency fails, for ") +
                       slopes(alpha_, beta_)};
}

Answer CircleCriterion::no_cycle() const {
  if (circle_answer_.decision == Decision::yes || applies_.decision != Decision::yes) return circle_answer_;
  return popov_answer_;
}

}  // namespace limcycle
