#include "limcycle/analysis/study/remedy/linear_costs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/golden_maximum.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/orbit/settle/watch/outcome_watch.hpp"
#include "limcycle/analysis/study/remedy/without.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

/// Slope of an element in the path of a signal; empty for one without.
std::optional<double> slope_of(const std::optional<Element>& element) {
  if (!element) return 1.0;
  const auto kind = element->kind();
  if (kind == "quantizer") return 1.0;
  if (kind != "dead-zone" && kind != "saturation") return std::nullopt;
  return element->number("slope").value_or(1.0);
}

/// From e to the command (of a cascade from y, its sign reversed), before the actuator.
Complex controller_at(const Controller& controller, const ControllerModel& model, Complex s) {
  Complex C = model.ss.at(s)(0, 0) + model.D_rate * s;
  const auto* cascade = std::get_if<Cascade>(&controller);
  if (cascade == nullptr) return C;
  C += s;
  return C * (cascade->velocity_kp + (cascade->velocity_ki != 0.0 ? cascade->velocity_ki / s : Complex(0.0)));
}

/// The loop in which only the friction is not linear.
std::optional<Loop> linear_loop(LoopParts parts) {
  if (!parts.friction) return std::nullopt;
  parts.element.reset();
  parts.error.reset();
  std::visit(
      []<class C>(C& controller) {
        controller.saturation = infinite;
        controller.friction_compensation = 0.0;
        if constexpr (std::is_same_v<C, Cascade>) {
          controller.limit = infinite;
          controller.anti_windup = {};
        }
        if constexpr (std::is_same_v<C, Pid>) {
          free_integral(controller);
          controller.impulse = controller.impulse_width = controller.impulse_pause = 0.0;
          controller.impulse_band = controller.impulse_speed = 0.0;
        }
      },
      parts.controller);
  if (validate(parts)) return std::nullopt;
  Loop loop = build_loop(parts);
  loop.sampled.reset();
  constexpr int order = 8;
  return loop.delay > 0.0 ? in_time_domain(loop, order).loop : loop;
}

bool is_stable(const Loop& loop) {
  const Eigen::VectorXcd poles = eigenvalues(loop.A);
  const double size = poles.size() == 0 ? 0.0 : poles.cwiseAbs().maxCoeff();
  return std::ranges::all_of(poles, [&](Complex s) { return s.real() < -1e-12 * size; });
}

/// Largest value of f over a grid, peaks between its points included.
double largest(const std::vector<double>& w, const std::function<double(double)>& f) {
  std::vector<double> values;
  values.reserve(w.size());
  for (const double one : w) values.push_back(f(one));
  double most = std::max(values.front(), values.back());
  for (std::size_t i = 1; i + 1 < w.size(); ++i)
    if (values[i] >= values[i - 1] && values[i] >= values[i + 1])
      most = std::max(most, f(std::exp(golden_maximum([&](double x) { return f(std::exp(x)); }, std::log(w[i - 1]),
                                                      std::log(w[i]), std::log(w[i + 1]), 45))));
  return most;
}

/// Frequencies at which |L| = 1.
std::vector<double> crossings(const std::vector<double>& w, const OpenLoop& open) {
  const auto above = [&](double at) { return std::abs(open.L({0.0, at})) > 1.0; };
  std::vector<double> found;
  bool before = above(w.front());
  for (std::size_t i = 1; i < w.size(); ++i) {
    const bool now = above(w[i]);
    if (now != before) {
      double low = w[i - 1], high = w[i];
      while (high > low * (1.0 + 1e-12)) {
        const double middle = std::sqrt(low * high);
        if (middle == low || middle == high) break;
        (above(middle) == before ? low : high) = middle;
      }
      found.push_back(std::sqrt(low * high));
    }
    before = now;
  }
  return found;
}

std::vector<double> frequencies(const Loop& loop) {
  const auto moduli = pole_moduli(loop);
  if (moduli.empty()) return {};
  constexpr double beyond = 1e3, a_decade = 200.0;
  const double low = moduli.front() / beyond, high = moduli.back() * beyond;
  const int points = static_cast<int>(std::ceil(a_decade * std::log10(high / low)));
  std::vector<double> w;
  for (int i = 0; i <= points; ++i) w.push_back(low * std::pow(high / low, static_cast<double>(i) / points));
  return w;
}

void add_margins(const OpenLoop& open, const std::vector<double>& w, LinearCosts& costs) {
  for (const double at : crossings(w, open)) {
    const double to_minus_one = std::arg(open.L({0.0, at})) + pi;  // 0 .. 2 pi
    const double least = std::min(to_minus_one, 2.0 * pi - to_minus_one), delay = to_minus_one / at;
    costs.phase_margin = std::min(costs.phase_margin.value_or(least), least);
    costs.delay_margin = std::min(costs.delay_margin.value_or(delay), delay);
  }
  costs.peak_sensitivity = largest(w, [&](double at) { return 1.0 / std::abs(1.0 + open.L({0.0, at})); });
  std::vector<double> noise(w.begin(), std::ranges::upper_bound(w, open.highest));
  if (noise.size() < w.size()) noise.push_back(open.highest);
  costs.noise_gain = open.unlimited_gain ? infinite : largest(noise, [&](double at) {
    const Complex s(0.0, at);
    return std::abs(open.C(s) / (1.0 + open.L(s)));
  });
}

/// y after a step, until the slowest mode has decayed.
void add_step(const Loop& loop, double step, LinearCosts& costs) {
  constexpr double time_constants = 12.0, least = 4000.0, most = 4e5, a_turn = 60.0;
  double slowest = infinite, fastest = 0.0;
  for (const Complex s : eigenvalues(loop.A)) {
    slowest = std::min(slowest, -s.real());
    fastest = std::max(fastest, std::abs(s));
  }
  if (!(slowest > 0.0) || !std::isfinite(slowest)) return;
  const double duration = time_constants / slowest;
  const int points = static_cast<int>(std::clamp(a_turn * duration * fastest / (2.0 * pi), least, most));
  const double h = duration / points;
  const Eigen::MatrixXd flow = exponential(loop.A * h);
  const LoopState from = displaced(loop, step);
  Eigen::VectorXd X = Eigen::Map<const Eigen::VectorXd>(from.x.data(), loop.states());
  const Eigen::RowVectorXd rate = loop.C_y * loop.A;
  Trace run;
  for (int i = 0; i <= points; ++i) {
    run.t.push_back(i * h);
    run.y.push_back((loop.C_y * X).value());
    run.rate.push_back((rate * X).value());
    X = flow * X;
  }
  const StepNumbers numbers = step_numbers(run, step);
  costs.settling_time = numbers.settling_time;
  costs.overshoot = numbers.overshoot;
}

}  // namespace

std::optional<OpenLoop> open_loop(const LoopParts& parts, std::string& why) {
  const auto refuse = [&](std::string reason) {
    why = std::move(reason);
    return std::nullopt;
  };
  if (parts.diagram) return refuse("a diagram has no one place at which the loop is opened");
  if (std::holds_alternative<NoController>(parts.controller) && parts.friction && !parts.element)
    return refuse("there is no controller");
  const PlantModel plant = std::visit([](const auto& one) { return one.model(); }, parts.plant);
  if (plant.gravity) return refuse("the plant is not linear");
  const auto forward = slope_of(parts.element), error = slope_of(parts.error);
  if (!forward || !error) return refuse("an element of the loop has no slope of its own");
  const Actuator& actuator = actuator_of(parts.controller);
  const Sampling& sampling = sampling_of(parts.controller);
  const ControllerModel model = model_of(parts.controller);
  if (*forward * *error != 1.0) return refuse("an element of the loop changes its gain");
  const double lag = actuator.lag, late = plant.delay + (sampling.is_on() ? sampling.mean_delay() : 0.0);
  OpenLoop open;
  open.C = [controller = parts.controller, model, lag](Complex s) {
    return controller_at(controller, model, s) / (1.0 + lag * s);
  };
  const StateSpace from_command{plant.A, plant.B_u, plant.C_y, Eigen::MatrixXd::Zero(1, 1)};
  open.L = [C = open.C, from_command, late](Complex s) {
    return C(s) * from_command.at(s)(0, 0) * std::exp(-s * late);
  };
  const bool derivative = model.D_rate != 0.0 || std::holds_alternative<Cascade>(parts.controller);
  open.unlimited_gain = derivative && lag == 0.0 && !sampling.is_on();
  if (sampling.is_on()) open.highest = pi / sampling.sample_time;
  return open;
}

std::optional<double> highest_crossover(const LoopParts& parts) {
  std::string why;
  const auto open = open_loop(parts, why);
  if (!open) return std::nullopt;
  const auto is_below_one = [&](double w) { return std::abs(open->L(Complex(0.0, w))) < 1.0; };
  constexpr double factor = 1.1;
  double above = 1e9;
  while (above > 1e-9 && is_below_one(above / factor)) above /= factor;
  if (above <= 1e-9 || above >= 1e9) return std::nullopt;
  double below = above / factor;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(below * above);
    (is_below_one(middle) ? above : below) = middle;
  }
  return above;
}

LinearCosts linear_costs(const LoopParts& parts, double step) {
  LinearCosts costs;
  const auto open = open_loop(parts, costs.why_not);
  const auto loop = open ? linear_loop(parts) : std::nullopt;
  if (!loop) {
    if (open) costs.why_not = parts.friction ? "the loop without its limits is not valid" : "there is no friction";
    return costs;
  }
  costs.stable = is_stable(*loop);
  if (!costs.stable) return costs;
  if (step != 0.0) add_step(*loop, step, costs);
  const auto w = frequencies(*loop);
  if (!w.empty()) add_margins(*open, w, costs);
  return costs;
}

StepNumbers step_numbers(const Trace& run, double step) {
  constexpr double near = 0.02;
  StepNumbers numbers;
  if (run.t.empty() || step == 0.0) return numbers;
  const double band = near * std::abs(step), end = run.y.back();
  for (std::size_t i = 0; i + 1 < run.t.size(); ++i) {
    const double h = run.t[i + 1] - run.t[i];
    if (!(h > 0.0)) continue;  // y does not jump
    const OutputStep y =
        OutputStep::through(run.t[i], run.t[i + 1], run.y[i], run.y[i + 1], run.rate[i], run.rate[i + 1]);
    double out = std::abs(y.y0 - end) > band ? 0.0 : -1.0;  // the last place outside
    const auto pass = [&](double theta) {
      const double value = y.value(theta);
      numbers.overshoot = std::max(numbers.overshoot, -value / step);
      if (std::abs(value - end) > band) out = theta;
    };
    pass(0.0);
    if (run.rate[i] * run.rate[i + 1] < 0.0) pass((y.turning().t - y.t) / h);
    pass(1.0);
    if (out < 0.0) continue;
    double inside = 1.0;
    for (int k = 0; out < 1.0 && k < 50; ++k) {
      const double middle = 0.5 * (out + inside);
      (std::abs(y.value(middle) - end) > band ? out : inside) = middle;
    }
    numbers.settling_time = run.t[i] + out * h - run.t.front();
  }
  return numbers;
}

}  // namespace limcycle
