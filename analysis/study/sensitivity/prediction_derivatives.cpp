#include "limcycle/analysis/study/sensitivity/prediction_derivatives.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/orbit/cycle/return_map.hpp"
#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"

namespace limcycle {
namespace {

using Point = std::complex<double>;
using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double of_equation = 1e-9;  ///< relative error of differences of G between neighbours
constexpr double frequencies_apart =
    1e-5;  ///< relative distance of frequencies in differences of exact G; poles may be near

/// Exact responses to the element's output.
struct Responses {
  Point input;         ///< of its own input: -G
  double y_per_input;  ///< amplitude of y per amplitude of the input
};
Responses responses(const Loop& loop, double w) {
  const Point input = loop.element_response(w)(0, 0), y = loop.output_response(w)(0);
  return {input, std::abs(y) / std::abs(input)};
}

struct ResponseSlopes {
  Point input;
  double y_per_input;
};
ResponseSlopes by_frequency_at(const Loop& loop, double w) {
  ResponseSlopes sum{0.0, 0.0};
  const double h = frequencies_apart * w;
  for (const auto& [steps, weight] : {std::pair(1.0, 45.0), {2.0, -9.0}, {3.0, 1.0}}) {
    const Responses above = responses(loop, w + steps * h), below = responses(loop, w - steps * h);
    sum.input += weight / (60.0 * h) * (above.input - below.input);
    sum.y_per_input += weight / (60.0 * h) * (above.y_per_input - below.y_per_input);
  }
  return sum;
}

std::optional<std::string> not_derivable(const Loop& loop) {
  if (loop.elements.size() != 1) return "only loops of one element: the balance of several is not differentiated";
  if (!loop.ports[0].rubs && !symmetry(loop)) return "a forward element with a bias: its mean is not differentiated";
  return std::nullopt;
}

double mean_speed(const Loop& loop) { return FirstHarmonicBalance(loop).mean_velocity(); }

Vector2d parts(Point z) { return {z.real(), z.imag()}; }

/// The linear equations for (dA, dw) of one root.
class RootMoves {
 public:
  RootMoves(const Loop& loop, double A, double w, const DfDerivatives& df)
      : A_(A), w_(w), df_(df), here_(responses(loop, w)), slopes_(by_frequency_at(loop, w)) {
    matrix_.col(0) = parts(df.amplitude.gain * here_.input) * A;  // relative to A and w
    matrix_.col(1) = parts(df.frequency.gain * here_.input + df.gain * slopes_.input) * w;
    inverse_ = matrix_.inverse();
    matrix_error_ = std::abs(here_.input) * (df.amplitude.error * A + df.frequency.error * w) + of_equation;
  }

  bool is_root() const { return std::abs(1.0 - df_.gain * here_.input) < 1e-6; }
  bool is_simple() const { return inverse_.allFinite() && matrix_.norm() * inverse_.norm() < 1e8; }
  double y_per_input() const { return here_.y_per_input; }

  PredictionDerivative by(const ParameterNeighbours& pair, const GainDerivative& of_gain) const {
    const Responses low = responses(pair.low, w_), high = responses(pair.high, w_);
    const Point of_input = (high.input - low.input) / (2.0 * pair.step);
    const double of_ratio = (high.y_per_input - low.y_per_input) / (2.0 * pair.step);
    const Vector2d pull = parts(of_gain.gain * here_.input + df_.gain * of_input);
    const Vector2d moved = -(inverse_ * pull);
    // Rounding of the difference: 1e-14 of N G, whose size is 1 there, over the step.
    const double rounding = 1e-14 / std::abs(pair.step);
    const double pull_error = of_gain.error * std::abs(here_.input) + of_equation * pull.norm() + rounding;
    const double error = inverse_.norm() * (pull_error + matrix_error_ * moved.norm());
    PredictionDerivative result;
    result.gain = of_gain;
    result.frequency = moved(1) * w_;
    result.frequency_error = error * w_;
    const double r = here_.y_per_input;
    result.amplitude = A_ * (r * moved(0) + slopes_.y_per_input * moved(1) * w_ + of_ratio);
    result.amplitude_error =
        A_ * ((r + std::abs(slopes_.y_per_input) * w_) * error + of_equation * std::abs(of_ratio) + rounding * r);
    return result;
  }

 private:
  double A_, w_;
  const DfDerivatives& df_;
  Responses here_;
  ResponseSlopes slopes_;
  Matrix2d matrix_, inverse_;
  double matrix_error_ = 0.0;
};

/// N by a parameter, including its effect on the speed of the belt.
GainDerivative with_bias(GainDerivative of_gain, const GainDerivative& by_bias, const ParameterNeighbours& pair) {
  const double of_speed = (mean_speed(pair.high) - mean_speed(pair.low)) / (2.0 * pair.step);
  of_gain.gain += by_bias.gain * of_speed;
  of_gain.error += by_bias.error * std::abs(of_speed);
  return of_gain;
}

}  // namespace

PredictionDerivatives prediction_derivatives(const Loop& loop, double input_amplitude, double frequency,
                                             std::span<const ParameterNeighbours> neighbours,
                                             const DfDerivativeOptions& options) {
  PredictionDerivatives result;
  const auto none = [&](Status status, std::string why) {
    result = {};
    result.status = status;
    result.why = std::move(why);
    return result;
  };
  if (auto why = not_derivable(loop)) return none(Status::undefined, std::move(*why));
  std::vector<ElementNeighbours> elements;
  for (const auto& pair : neighbours)
    elements.push_back({pair.low.elements.at(0), pair.high.elements.at(0), pair.step, pair.value});
  const DfDerivatives df =
      df_derivatives(loop.elements[0], input_amplitude, frequency, mean_speed(loop), elements, options);
  if (df.status != Status::converged) return none(df.status, df.why);
  const RootMoves moves(loop, input_amplitude, frequency, df);
  if (!moves.is_root()) return none(Status::stalled, "the balance is not met there");
  if (!moves.is_simple()) return none(Status::stalled, "two predicted oscillations merge there");
  result.input_amplitude = input_amplitude;
  result.amplitude = input_amplitude * moves.y_per_input();
  result.frequency = frequency;
  result.gain = df.gain;
  result.gain_error = df.gain_error;
  result.by_amplitude = df.amplitude;
  result.by_frequency = df.frequency;
  for (std::size_t k = 0; k < neighbours.size(); ++k)
    result.by.push_back(moves.by(neighbours[k], with_bias(df.by[k], df.bias, neighbours[k])));
  return result;
}

}  // namespace limcycle
