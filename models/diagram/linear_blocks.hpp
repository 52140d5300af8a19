#pragma once
#include <string>
#include <variant>

#include "limcycle/models/linear/state_space.hpp"
#include "limcycle/models/parameter.hpp"

namespace limcycle {

/// Linear part of a block: time dx/dt = A x + B u, y = C x + D u, all outputs delayed by `delay`.
struct LinearModel {
  StateSpace ss;
  double time = 1.0, delay = 0.0;
  std::vector<std::string> state_names;
};

/// y = gain u.
struct Gain {
  double gain{};
  static constexpr std::string_view kind = "gain";
  static constexpr std::string_view equation = "y = gain u";
  static std::vector<Parameter<Gain, double>> parameters() {
    return {{"gain", "1", "factor", &Gain::gain, any_number}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  LinearModel model() const;
};

/// y = u, where u is the sum written as the input of the block.
struct SumBlock {
  static constexpr std::string_view kind = "sum";
  static constexpr std::string_view equation = "y = u, the sum written as its input";
  static std::vector<Parameter<SumBlock, double>> parameters() { return {}; }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  LinearModel model() const;
};

/// y = value; no input.
struct Constant {
  double value{};
  static constexpr std::string_view kind = "constant";
  static constexpr std::string_view equation = "y = value";
  static std::vector<Parameter<Constant, double>> parameters() {
    return {{"value", "1", "the constant", &Constant::value, any_number}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
};

/// dy/dt = gain u - leak y.
struct Integrator {
  double gain{1.0}, leak{0.0};
  static constexpr std::string_view kind = "integrator";
  static constexpr std::string_view equation = "dy/dt = gain u - leak y";
  static std::vector<Parameter<Integrator, double>> parameters() {
    return {{"gain", "1/s", "factor of the input", &Integrator::gain, any_number, false},
            {"leak", "1/s", "rate at which it forgets", &Integrator::leak, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  LinearModel model() const;
};

/// y = gain/(time_constant s + 1) u.
struct LowPass {
  double time_constant{}, gain{1.0};
  static constexpr std::string_view kind = "low-pass";
  static constexpr std::string_view equation = "time_constant dy/dt = gain u - y";
  static std::vector<Parameter<LowPass, double>> parameters() {
    return {{"time_constant", "s", "time constant", &LowPass::time_constant, positive},
            {"gain", "1", "gain at rest", &LowPass::gain, any_number, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  LinearModel model() const;
};

/// y = gain (lead s + 1)/(lag s + 1) u.
struct LeadLag {
  double lead{}, lag{}, gain{1.0};
  static constexpr std::string_view kind = "lead-lag";
  static constexpr std::string_view equation = "y = gain (lead s + 1)/(lag s + 1) u";
  static std::vector<Parameter<LeadLag, double>> parameters() {
    return {{"lead", "s", "time constant of the numerator", &LeadLag::lead, not_negative},
            {"lag", "s", "time constant of the denominator", &LeadLag::lag, positive},
            {"gain", "1", "gain at rest", &LeadLag::gain, any_number, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  LinearModel model() const;
};

/// y = (s^2 + 2 depth damping w s + w^2)/(s^2 + 2 damping w s + w^2) u, w = frequency; at w the gain is `depth`.
struct Notch {
  double frequency{}, damping{}, depth{0.0};
  static constexpr std::string_view kind = "notch";
  static constexpr std::string_view equation =
      "y = (s^2 + 2 depth damping w s + w^2)/(s^2 + 2 damping w s + w^2) u, w = frequency";
  static std::vector<Parameter<Notch, double>> parameters() {
    return {{"frequency", "rad/s", "frequency that is taken out", &Notch::frequency, positive},
            {"damping", "1", "damping ratio of the poles: half of the relative width", &Notch::damping, positive},
            {"depth", "1", "gain at the frequency", &Notch::depth, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
  LinearModel model() const;
};

/// y(t) = u(t - delay), for an input that is made of states only.
struct DelayBlock {
  double delay{};
  static constexpr std::string_view kind = "delay";
  static constexpr std::string_view equation = "y(t) = u(t - delay)";
  static std::vector<Parameter<DelayBlock, double>> parameters() {
    return {{"delay", "s", "dead time", &DelayBlock::delay, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }
};

/// y = numerator(s)/denominator(s) u, proper. (A strictly proper one is read as a plant: friction may act on it.)
struct ProperTransferFunction {
  std::vector<double> numerator, denominator;
  static constexpr std::string_view kind = "transfer-function";
  static constexpr std::string_view equation = "y = numerator(s)/denominator(s) u, highest power first";
  static std::vector<Parameter<ProperTransferFunction, double>> parameters() {
    using Self = ProperTransferFunction;
    return {{"numerator", "1", "coefficients, highest power first", &Self::numerator},
            {"denominator", "1", "coefficients, highest power first", &Self::denominator}};
  }
  std::optional<BrokenRule> validate() const;
  LinearModel model() const;
};

/// dx/dt = A x + B u, y = C x + D u, with any number of inputs and outputs. (One without feed-through and with one
/// input and output is read as a plant: friction may act on it.)
struct StateSpaceBlock {
  Eigen::MatrixXd A, B, C, D{Eigen::MatrixXd(0, 0)};
  static constexpr std::string_view kind = "state-space";
  static constexpr std::string_view equation = "dx/dt = A x + B u, y = C x + D u";
  static std::vector<Parameter<StateSpaceBlock, double>> parameters() {
    using Self = StateSpaceBlock;
    return {{"A", "1", "rows as lists", &Self::A},
            {"B", "1", "rows as lists", &Self::B},
            {"C", "1", "rows as lists", &Self::C},
            {"D", "1", "feed-through", &Self::D, any_number, false}};
  }
  std::optional<BrokenRule> validate() const;
  LinearModel model() const;
};

using LinearBlock = std::variant<Gain, SumBlock, Constant, Integrator, LowPass, LeadLag, Notch, DelayBlock,
                                 ProperTransferFunction, StateSpaceBlock>;

/// The linear part of any of them; without states and zero for a constant and a delay.
LinearModel model_of(const LinearBlock& block);

}  // namespace limcycle
