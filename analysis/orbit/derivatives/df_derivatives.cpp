#include "limcycle/analysis/orbit/derivatives/df_derivatives.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "limcycle/analysis/orbit/cycle/cycle_equations.hpp"
#include "limcycle/analysis/orbit/cycle/cycle_pieces.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Gain = std::complex<double>;

constexpr double start_phase = 0.3704;   ///< away from every round value at which an element might switch
constexpr double looser_period = 30.0;   ///< the second integration
constexpr double stated_of_gain = 0.35;  ///< of the difference of the two, as for cycles (cycle_derivatives.cpp)
constexpr double step_share = 1e-6;      ///< of amplitude and frequency
constexpr Index of_oscillator = 4;       ///< s, c, q1, q2
constexpr int most_periods = 60;
enum Drive : Index { by_amplitude, by_frequency, by_bias, drive_count };

VectorXd driven_vector(const State& x) { return Eigen::Map<const VectorXd>(x.data(), std::ssize(x)); }

/// Motion that drives an element.
struct Driven {
  double amplitude, frequency, bias;
};

/// The element with the oscillator before it and the resonance after it.
Loop driven_loop(const Element& element, const Driven& by) {
  const double A = by.amplitude, w = by.frequency;
  Loop loop;
  loop.A = loop.A_delayed = MatrixXd::Zero(of_oscillator, of_oscillator);
  loop.A(0, 1) = loop.A(2, 3) = w;
  loop.A(1, 0) = loop.A(3, 2) = -w;
  loop.B = MatrixXd::Zero(of_oscillator, 1);
  loop.B(3, 0) = 1.0;
  loop.E.setZero(of_oscillator, 4);
  loop.C_y = Eigen::RowVectorXd::Unit(of_oscillator, 0);
  loop.external(constant_one) = 1.0;
  Port port;
  port.C = A * Eigen::RowVectorXd::Unit(of_oscillator, 0);
  port.C_v = A * w * Eigen::RowVectorXd::Unit(of_oscillator, 1);
  port.D = port.D_v = Eigen::RowVectorXd::Zero(1);
  port.c.setZero();
  port.c_v.setZero();
  port.rubs = element.is_friction();
  (port.rubs ? port.c_v : port.c)(constant_one) = by.bias;
  port.C_delayed = Eigen::RowVectorXd::Zero(of_oscillator);
  port.opposes = port.rubs;
  port.path = port.rubs ? "loop.friction" : "loop.element";
  loop.ports.push_back(std::move(port));
  loop.elements.push_back(element);
  loop.state_names = {"s", "c", "q1", "q2"};
  return loop;
}

/// Reason why there is no derivative for this element, or nothing.
std::optional<std::string> refusal(const Element& element, const Driven& by) {
  if (element.facts().keeps_return_points)
    return "the law keeps its return points, whose number changes from one motion to the next";
  if (element.follows_position() && by.bias != 0.0) return "a mean velocity stretches a spring in the law without end";
  const double band = element.drive_band();
  if (band > 0.0 && std::abs(by.bias) - by.amplitude * by.frequency <= band)
    return "where the motion enters |v| < dv the law needs the applied force, and a prescribed motion has none";
  return std::nullopt;
}

/// One element on the way to its periodic state.
class DrivenPeriod {
 public:
  DrivenPeriod(const Element& element, const Driven& by, bool half, const DfDerivativeOptions& options)
      : element_(element), by_(by), half_(half), loop_(driven_loop(element, by)) {
    cut_.max_steps = options.max_steps;
    cut_.stop = options.stop;
    const double output = element.scales().output / by.frequency;
    cut_.typical = State{1.0, 1.0, output, output};
    for (int i = 0; i < element.states(); ++i) {
      cut_.typical->push_back(element.state_scale(i));
      mirror_.push_back(element.even_state(i) ? 1.0 : -1.0);
    }
  }

  const Loop& loop() const { return loop_; }
  double length() const { return (half_ ? 1.0 : 2.0) * std::numbers::pi / by_.frequency; }
  Index own() const { return std::ssize(mirror_); }

  /// Finds a state and modes of the element that return; otherwise the reason why there are none.
  std::optional<std::string> settle(double rtol);

  /// Gain, and its derivatives: a column for each of the pairs.
  struct Row {
    Gain gain;
    std::vector<Gain> by;  ///< total, at a given element input amplitude and frequency of the formula for N
  };
  std::optional<std::string> derive(double rtol, ParameterRates& rates, Row& row);

 private:
  struct Passed {
    CyclePieces cut;
    PeriodMap map;
  };
  Passed pass(double rtol, ParameterRates& rates) {
    cut_.rtol = rtol;
    Passed passed{cut_cycle(loop_, start_, length(), rates, cut_), {}};
    passed.map = period_map(passed.cut);
    return passed;
  }

  /// The modes at the end, and the states of the element there less those at the start, after mirroring if this is
  /// half a period.
  std::vector<Mode> modes_after(const Passed& passed) const {
    std::vector<Mode> modes = passed.cut.last.modes;
    if (half_) modes[0] = element_.mirror(modes[0]);
    return modes;
  }
  VectorXd mirrored() const {
    return half_ ? VectorXd(Eigen::Map<const VectorXd>(mirror_.data(), own())) : VectorXd::Ones(own());
  }
  VectorXd defect(const Passed& passed) const {
    return mirrored().cwiseProduct(driven_vector(passed.cut.last.x).tail(own())) - driven_vector(start_.x).tail(own());
  }
  VectorXd own_sizes() const {
    return Eigen::Map<const VectorXd>(cut_.typical->data(), std::ssize(*cut_.typical)).tail(own());
  }
  MatrixXd loop_matrix(const Passed& passed) const {
    return MatrixXd::Identity(own(), own()) -
           MatrixXd(mirrored().asDiagonal() * passed.map.whole.bottomRightCorner(own(), own()));
  }
  /// (I - P_z)^-1 in the sizes of the states; not finite if P_z has an eigenvalue 1.
  MatrixXd close(const Passed& passed, const MatrixXd& right) const {
    const VectorXd sizes = own_sizes();
    const MatrixXd matrix = sizes.cwiseInverse().asDiagonal() * loop_matrix(passed) * sizes.asDiagonal();
    const MatrixXd scaled = sizes.cwiseInverse().asDiagonal() * right;
    MatrixXd solution = solve_columns_fully_pivoted(matrix, scaled);
    const bool solved =
        (matrix * solution - scaled).norm() <= 1e-6 * scaled.norm() && solution.norm() <= 1e8 * scaled.norm();
    if (!solved) solution.setConstant(infinite);
    return sizes.asDiagonal() * solution;
  }

  const Element& element_;
  Driven by_;
  bool half_;
  Loop loop_;
  CutOptions cut_;
  std::vector<double> mirror_;
  LoopState start_;
};

std::string sentence(Status status) {
  if (status == Status::stalled) return "a switch is grazed, or comes in another order beside the motion";
  return "the motion could not be followed: " + std::string(to_string(status));
}

std::optional<std::string> DrivenPeriod::settle(double rtol) {
  VectorXd X = VectorXd::Zero(of_oscillator);
  X(0) = std::sin(start_phase);
  X(1) = std::cos(start_phase);
  start_ = without_history(loop_, X);
  ParameterRates no_parameters(loop_, {});
  for (int i = 0; i < most_periods; ++i) {
    const Passed passed = pass(i < 2 ? std::max(rtol, 1e-7) : rtol, no_parameters);
    if (passed.cut.status != Status::converged) return sentence(passed.cut.status);
    const auto modes = modes_after(passed);
    const bool same = modes == start_.modes;
    VectorXd step = defect(passed);
    // Where many states are possible, the way from rest decides which is reached; Newton follows.
    if (same && i >= 2 && own() > 0) {
      const VectorXd newton = close(passed, step);
      if (newton.allFinite()) step = newton;
    }
    Eigen::Map<VectorXd>(start_.x.data() + of_oscillator, own()) += step;
    start_.modes = modes;
    const double far = own() > 0 ? step.cwiseQuotient(own_sizes()).cwiseAbs().maxCoeff() : 0.0;
    if (same && i > 2 && far <= 100.0 * rtol) return std::nullopt;
  }
  return "no periodic state was found";
}

std::optional<std::string> DrivenPeriod::derive(double rtol, ParameterRates& rates, Row& row) {
  const Passed passed = pass(rtol, rates);
  if (passed.cut.status != Status::converged) return sentence(passed.cut.status);
  if (modes_after(passed) != start_.modes) return "the motion does not come back to its modes";
  MatrixXd columns = passed.map.columns;
  // The period ends earlier at a higher frequency.
  columns.col(by_frequency) -= driven_vector(passed.cut.pieces.back().step.dx1) * (length() / by_.frequency);
  MatrixXd q = columns.middleRows(2, 2);
  if (own() > 0) {
    const MatrixXd z = close(passed, mirrored().asDiagonal() * columns.bottomRows(own()));
    if (!z.allFinite()) return "the periodic state is not unique: the law keeps something of what was before";
    q += passed.map.whole.block(2, of_oscillator, 2, own()) * z;
  }
  const double w = by_.frequency, A = by_.amplitude;
  const Gain factor = (half_ ? -2.0 : 1.0) * w / (std::numbers::pi * A) * std::polar(1.0, -start_phase);
  const auto gain = [&](double q1, double q2) { return factor * Gain(-q1, q2); };
  row.gain = gain(passed.cut.last.x[2], passed.cut.last.x[3]);
  for (Index k = 0; k < q.cols(); ++k) row.by.push_back(gain(q(0, k), q(1, k)));
  row.by[by_amplitude] -= row.gain / A;
  row.by[by_frequency] += row.gain / w;
  return std::nullopt;
}

/// Neighbours of the driven loop: in amplitude, frequency and bias, and in the parameters of the element.
std::vector<ParameterNeighbours> loops_beside(const Element& element, const Driven& by,
                                              std::span<const ElementNeighbours> neighbours) {
  std::vector<ParameterNeighbours> pairs;
  const double size = element.is_friction() ? by.amplitude * by.frequency : by.amplitude;
  for (const auto& [member, at] : {std::pair(&Driven::amplitude, by.amplitude),
                                   {&Driven::frequency, by.frequency},
                                   {&Driven::bias, std::max(std::abs(by.bias), size)}}) {
    Driven low = by, high = by;
    low.*member -= step_share * at;
    high.*member += step_share * at;
    pairs.push_back({driven_loop(element, low), driven_loop(element, high), 0.5 * (high.*member - low.*member), at});
  }
  for (const auto& pair : neighbours)
    pairs.push_back({driven_loop(pair.low, by), driven_loop(pair.high, by), pair.step, pair.value});
  return pairs;
}

bool is_odd(const Element& element) { return element.odd(); }

GainDerivative judged(Gain tight, Gain rough, Gain of, double step) {
  return {tight, stated_of_gain * std::abs(tight - rough) + 1e-9 * std::abs(tight) + 1e-14 * std::abs(of) / step};
}

DfDerivatives joined(const DrivenPeriod::Row& tight, const DrivenPeriod::Row& rough, const ParameterRates& rates) {
  DfDerivatives result;
  result.gain = tight.gain;
  result.gain_error = stated_of_gain * std::abs(tight.gain - rough.gain) + 1e-12 * std::abs(tight.gain);
  for (std::size_t k = 0; k < tight.by.size(); ++k)
    result.by.push_back(judged(tight.by[k], rough.by[k], tight.gain, rates.step(static_cast<Index>(k))));
  result.amplitude = result.by[by_amplitude];
  result.frequency = result.by[by_frequency];
  result.bias = result.by[by_bias];
  result.by.erase(result.by.begin(), result.by.begin() + drive_count);
  return result;
}

}  // namespace

DfDerivatives df_derivatives(const Element& element, double amplitude, double frequency, double bias,
                             std::span<const ElementNeighbours> neighbours, const DfDerivativeOptions& options) {
  if (!(std::isfinite(amplitude) && amplitude > 0.0 && std::isfinite(frequency) && frequency > 0.0 &&
        std::isfinite(bias)))
    throw std::invalid_argument("amplitude and frequency must be finite and positive, the bias finite");
  const Driven by{amplitude, frequency, bias};
  DfDerivatives result;
  const auto none = [&](Status status, std::string why) {
    result = {};
    result.status = status;
    result.why = std::move(why);
    return result;
  };
  if (auto why = refusal(element, by)) return none(Status::undefined, std::move(*why));
  const bool half = bias == 0.0 && is_odd(element) && std::ranges::all_of(neighbours, [](const auto& pair) {
                      return is_odd(pair.low) && is_odd(pair.high);
                    });
  DrivenPeriod period(element, by, half, options);
  const auto pairs = loops_beside(element, by, neighbours);
  ParameterRates rates(period.loop(), pairs);
  DrivenPeriod::Row tight, rough;
  auto why = period.settle(options.rtol);
  if (!why) why = period.derive(options.rtol, rates, tight);
  if (!why) why = period.settle(looser_period * options.rtol);
  if (!why) why = period.derive(looser_period * options.rtol, rates, rough);
  if (options.stop && options.stop()) return none(Status::interrupted, "it was stopped");
  if (why) return none(why->starts_with("the periodic state") ? Status::undefined : Status::stalled, std::move(*why));
  result = joined(tight, rough, rates);
  if (half) result.bias = {};  // half a period has no derivative by the bias; N is even in it
  for (const auto& one : result.by)
    if (!std::isfinite(std::abs(one.gain))) return none(Status::not_finite, "the derivative is not finite");
  return result;
}

}  // namespace limcycle
