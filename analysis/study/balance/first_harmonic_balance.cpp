#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <span>

#include "limcycle/analysis/frequency/describing_function/df_table.hpp"
#include "limcycle/analysis/frequency/describing_function/gain_surface.hpp"
#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/analysis/orbit/cycle/return_map.hpp"
#include "limcycle/analysis/study/balance/quasi_linear.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/quantizer.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

constexpr Complex undefined{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

DfOptions first_harmonic(double accuracy) {
  DfOptions options;
  options.harmonics = 1;
  options.accuracy = std::clamp(accuracy, 1e-12, 1e-2);
  return options;
}

DescribingFunction df(const Element& element, double A, double w, double bias, double accuracy) {
  return describing_function(element, {A, w, bias}, first_harmonic(accuracy));
}

/// Closed form if the element offers one, at no cost.
std::optional<Complex> exact_gain(const Element& element, double A, double w, double bias) {
  return element.exact_describing_function(A, w, bias);
}

double mean_output(const Element& element, double A, double w, double bias, double accuracy,
                   std::atomic<long>& evaluations) {
  if (const auto exact = element.exact_mean(A, bias)) return *exact;
  const DescribingFunction computed = df(element, A, w, bias, accuracy);
  evaluations += computed.evaluations;
  return computed.mean;
}

bool is_friction(const Loop& loop, std::size_t i) { return loop.ports[i].rubs; }

/// True for the elements that may limit a command or stand on an error.
bool is_limit_or_gap(const Element& element) {
  return element.as<Saturation<double>>() || element.as<DeadZone<double>>() || element.as<Quantizer<double>>();
}

bool pulls_back(const Loop& loop, std::size_t i) { return loop.elements[i].pull(0.0, 0.0).has_value(); }

}  // namespace

/// The describing function of the main element; a search for roots needs thousands of values at few accuracies.
class FirstHarmonicBalance::MainGain {
 public:
  explicit MainGain(const Element& element) : element_(&element) {}

  /// The gain interpolated, for a search that needs many values; empty where it is not smooth, or at this accuracy.
  std::optional<Complex> interpolated(const DfPoint& point, double accuracy) {
    if (accuracy < interpolation_accuracy) return std::nullopt;
    const std::lock_guard lock(guard_);
    if (!surface_) surface_.emplace(*element_, point.bias, interpolation_accuracy);
    const long before = surface_->evaluations();
    const auto found = surface_->at(point.amplitude, point.frequency);
    evaluations += surface_->evaluations() - before;
    return found;
  }

  std::atomic<long> evaluations = 0;  ///< of the element's equations

  DescribingFunction at(const DfPoint& point, double accuracy) {
    {
      const std::lock_guard lock(guard_);
      if (accuracy == prepared_accuracy_)
        if (const auto known = prepared_.find({point.amplitude, point.frequency, point.bias}); known != prepared_.end())
          return known->second;
    }
    DescribingFunction result = table(accuracy).at(point);
    evaluations += result.evaluations;
    return result;
  }

  /// Discards earlier prepared values.
  void prepare(std::span<const DfPoint> points, double accuracy, const std::function<bool()>& stop) {
    {
      const std::lock_guard lock(guard_);
      prepared_.clear();
      prepared_accuracy_ = accuracy;
    }
    // As many at a time as a stop can wait for: a point of a stiff law may take ten thousand evaluations, one of
    // LuGre 50.
    constexpr long evaluations_at_once = 200'000;
    constexpr std::size_t fewest = 16, most = 512;
    for (std::size_t at_once = fewest; !points.empty() && !(stop && stop());) {
      const auto now = points.first(std::min(at_once, points.size()));
      const long before = evaluations;
      add_prepared(now, accuracy);
      const auto each = static_cast<std::size_t>(evaluations - before) / now.size() + 1;
      at_once = std::clamp(static_cast<std::size_t>(evaluations_at_once) / each, fewest, most);
      points = points.subspan(now.size());
    }
  }

 private:
  using Place = std::array<double, 3>;

  void add_prepared(std::span<const DfPoint> points, double accuracy) {
    auto results = table(accuracy).some_of(points);
    for (const DescribingFunction& result : results) evaluations += result.evaluations;
    const std::lock_guard lock(guard_);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!results[i].method.empty())
        prepared_.emplace(Place{points[i].amplitude, points[i].frequency, points[i].bias}, std::move(results[i]));
  }

  const DfTable& table(double accuracy) {
    const std::lock_guard lock(guard_);
    auto& made = by_accuracy_[accuracy];
    if (!made) made = std::make_unique<DfTable>(*element_, std::vector<DfPoint>{}, first_harmonic(accuracy));
    return *made;
  }

  static constexpr double interpolation_accuracy = 1e-4;

  const Element* element_;
  std::mutex guard_;
  std::optional<GainSurface> surface_;
  std::map<double, std::unique_ptr<DfTable>> by_accuracy_;
  double prepared_accuracy_ = 0.0;
  std::map<Place, DescribingFunction> prepared_;
};

void FirstHarmonicBalance::prepare(const std::vector<SearchPoint>& points, double accuracy,
                                   const std::function<bool()>& stop) const {
  // Means of the inputs of other elements depend on the point; values beside a second element are interpolated.
  if (!is_friction(*loop_, main_) || other_) return;
  if (!points.empty() && exact_gain(loop_->elements[main_], points[0].amplitude, points[0].frequency, mean_velocity_))
    return;  // nothing to compute
  std::vector<DfPoint> at;
  at.reserve(points.size());
  for (const SearchPoint& point : points) at.push_back({point.amplitude, point.frequency, mean_velocity_});
  main_gain_->prepare(at, accuracy, stop);
}

/// Sorts all elements but the last into those parallel to it and the rest.
FirstHarmonicBalance::Sorted FirstHarmonicBalance::sort(const Loop& loop) {
  Sorted sorted;
  const Port& main = loop.ports.back();
  for (std::size_t i = 0; i + 1 < loop.elements.size(); ++i) {
    const Port& port = loop.ports[i];
    const double size = main.C.squaredNorm();
    // If no state holds the rubbing displacement its row is zero, as is that of the compensation.
    const double factor = size > 0.0 ? main.C.dot(port.C) / size : main.rubs && port.rubs ? 1.0 : 0.0;
    const bool same = factor != 0.0 && loop.delay == 0.0 && port.D.isZero() && main.D.isZero() &&
                      (port.C - factor * main.C).norm() <= 1e-12 * port.C.norm();
    if (same)
      sorted.beside.push_back({i, factor});
    else
      sorted.others.push_back(i);
  }
  return sorted;
}

std::optional<std::string> FirstHarmonicBalance::not_applicable(const Loop& loop) {
  const std::size_t n = loop.elements.size();
  const Sorted sorted = sort(loop);
  if (sorted.others.size() > 1)
    return "the plain describing function is for one nonlinear element with at most one saturated command or error "
           "element beside it";
  const std::string other = sorted.others.empty() ? "" : loop.ports[sorted.others.front()].path;
  const bool block = other.starts_with("diagram.") && !is_limit_or_gap(loop.elements[sorted.others.front()]);
  if (other == "loop.element" || other.ends_with(".rate") || block)
    return "the plain describing function is for one nonlinear element; this loop has others with inputs of their own";
  if (symmetry(loop)) return std::nullopt;
  for (const auto& [index, factor] : sorted.beside)
    if (!loop.ports[index].rubs && !pulls_back(loop, index))
      return "the loop is biased (load, reference, belt) and has an element on the error";
  if (is_friction(loop, n - 1)) return std::nullopt;
  if (rank(loop.A) < loop.A.rows())
    return "the loop is biased (load or reference) and integrates: the mean is not determined by a static balance";
  if (n > 1) return "the loop is biased (load or reference) and has more than one element";
  return std::nullopt;
}

FirstHarmonicBalance::FirstHarmonicBalance(const Loop& loop)
    : loop_(&loop),
      main_(loop.elements.size() - 1),
      main_gain_(std::make_shared<MainGain>(loop.elements[main_])),
      symmetric_(symmetry(loop).has_value()) {
  const Sorted sorted = sort(loop);
  beside_ = sorted.beside;
  if (!sorted.others.empty()) {
    other_ = sorted.others.front();
    second_.emplace(loop.elements[*other_]);
  }
  if (symmetric_) return;
  if (other_) {
    passing_.emplace(loop);
    passing_->A = working_loop(loop) - loop.A_delayed;
  }
  if (!is_friction(loop, main_)) return;
  bool exact = false;
  const Port& port = loop.ports[main_];
  const double mean = (port.C_v * mean_loop().rest_point(exact) + port.c_v * loop.external).value();
  if (std::abs(mean) > 1e-12 * typical_rubbing_velocity(loop)) mean_velocity_ = mean;  // else a rounding
}

double FirstHarmonicBalance::mean_velocity() const { return mean_velocity_; }
long FirstHarmonicBalance::evaluations() const { return main_gain_->evaluations; }

bool FirstHarmonicBalance::depends_on_frequency() const { return is_friction(*loop_, main_); }

/// Mean of the main element's input (friction: mean rubbing velocity). A biased forward element settles where the
/// static balance holds: mean input = rest + H(0) mean output.
double FirstHarmonicBalance::bias(double amplitude, double frequency, double accuracy) const {
  const Port& port = loop_->ports[main_];
  if (is_friction(*loop_, main_)) return mean_velocity_;
  if (symmetric_) return 0.0;
  bool exact = false;
  const double rest = (port.C * loop_->rest_point(exact) + port.c * loop_->external).value();
  const double slope = loop_->element_response(0.0)(0, 0).real();
  const auto balance = [&](double b) {
    return rest - b +
           slope * mean_output(loop_->elements[main_], amplitude, frequency, b, accuracy, main_gain_->evaluations);
  };
  const double first = balance(rest);
  if (first == 0.0) return rest;
  double low = rest, high = rest, at_low = first, at_high = first;
  double width = std::abs(first);
  for (int i = 0; i < 60 && at_low < 0.0; ++i) at_low = balance(low -= width *= 2.0);
  for (int i = 0; i < 60 && at_high > 0.0; ++i) at_high = balance(high += width *= 2.0);
  if (!(at_low >= 0.0 && at_high <= 0.0)) return rest;
  std::uintmax_t steps = 100;
  const auto narrow = [&](double a, double b) { return std::abs(b - a) <= 1e-14 * (std::abs(a) + std::abs(b)); };
  std::tie(low, high) = boost::math::tools::toms748_solve(balance, low, high, at_low, at_high, narrow, steps);
  return 0.5 * (low + high);
}

bool FirstHarmonicBalance::has_gravity() const {
  for (std::size_t i = 0; i < loop_->elements.size(); ++i)
    if (pulls_back(*loop_, i)) return true;
  return false;
}

/// Mean of the linear states: that under the mean output of the main element, with gravity reduced by the swing.
Eigen::VectorXd FirstHarmonicBalance::mean_state(double amplitude, double frequency, double accuracy,
                                                 bool& exact) const {
  const auto ne = std::ssize(loop_->elements);
  Eigen::VectorXd outputs = Eigen::VectorXd::Zero(ne), swings = Eigen::VectorXd::Zero(ne);
  const double b = bias(amplitude, frequency, accuracy);
  outputs(static_cast<Index>(main_)) = df(loop_->elements[main_], amplitude, frequency, b, accuracy).mean;
  for (const auto& [index, factor] : beside_) swings(static_cast<Index>(index)) = std::abs(factor) * amplitude;
  return mean_loop().mean_point(outputs, swings, exact);
}

Eigen::VectorXd FirstHarmonicBalance::mean_inputs(double amplitude, double frequency, double accuracy) const {
  const auto ne = std::ssize(loop_->elements);
  Eigen::VectorXd means = Eigen::VectorXd::Zero(ne);
  if (symmetric_) return means;
  bool exact = false;
  const Eigen::VectorXd X = mean_state(amplitude, frequency, accuracy, exact);
  for (Index i = 0; i < ne; ++i) {
    const Port& port = loop_->ports[static_cast<std::size_t>(i)];
    means(i) = ((port.C + port.C_delayed) * X + port.c * loop_->external).value();
  }
  return exact ? means : Eigen::VectorXd::Constant(ne, undefined.real());
}

Complex FirstHarmonicBalance::gain(double amplitude, double frequency, double accuracy) const {
  const double mean = bias(amplitude, frequency, accuracy);
  const auto exact = exact_gain(loop_->elements[main_], amplitude, frequency, mean);
  if (exact && *exact == 0.0 && !symmetric_ && !is_friction(*loop_, main_))
    return undefined;  // e.g. a biased relay that does not switch
  if (exact) return *exact;
  // Beside a second element, each point of the loop condition needs many amplitudes.
  if (other_ && is_friction(*loop_, main_))
    if (const auto interpolated = main_gain_->interpolated({amplitude, frequency, mean}, accuracy))
      return *interpolated;
  const auto result = main_gain_->at({amplitude, frequency, mean}, accuracy);
  if (result.status != Status::converged && result.status != Status::incomplete) return undefined;
  if (symmetric_ && !result.symmetric) return undefined;  // e.g. a relay that does not switch
  return result.gain;
}

Complex FirstHarmonicBalance::operator()(double amplitude, double frequency, double accuracy) const {
  if (loop_->elements.size() > 1) return oscillation(amplitude, frequency, accuracy).left;
  const Complex N = gain(amplitude, frequency, accuracy);
  return std::isfinite(N.real()) ? 1.0 - N * loop_->element_response(frequency)(0, 0) : undefined;
}

Complex FirstHarmonicBalance::beside_gain(const Beside& beside, double amplitude, double frequency, double mean,
                                          double accuracy) const {
  if (!std::isfinite(mean)) return undefined;
  const double A = std::abs(beside.factor) * amplitude;
  const auto exact = exact_gain(loop_->elements[beside.index], A, frequency, mean);
  return exact ? *exact : df(loop_->elements[beside.index], A, frequency, mean, accuracy).gain;
}

/// Phasors (sine reference) of the outputs of the main element and of those parallel to it.
Eigen::VectorXcd FirstHarmonicBalance::own_outputs(double amplitude, double frequency, double accuracy) const {
  Eigen::VectorXcd W = Eigen::VectorXcd::Zero(std::ssize(loop_->elements));
  W(static_cast<Index>(main_)) = gain(amplitude, frequency, accuracy) * amplitude;
  const Eigen::VectorXd means = has_gravity() ? mean_inputs(amplitude, frequency, accuracy) : Eigen::VectorXd();
  for (const auto& [index, factor] : beside_) {
    const auto k = static_cast<Index>(index);
    const double mean = is_friction(*loop_, index) || means.size() == 0 ? mean_velocity_ : means(k);
    W(k) = beside_gain({index, factor}, amplitude, frequency, mean, accuracy) * factor * amplitude;
  }
  return W;
}

/// The same of all elements on the predicted oscillation.
Eigen::VectorXcd FirstHarmonicBalance::outputs(double amplitude, double frequency, double accuracy) const {
  return other_ ? oscillation(amplitude, frequency, accuracy).outputs : own_outputs(amplitude, frequency, accuracy);
}

double FirstHarmonicBalance::output_amplitude(double amplitude, double frequency) const {
  return std::abs((loop_->output_response(frequency) * outputs(amplitude, frequency, 1e-9)).value());
}

std::optional<bool> FirstHarmonicBalance::stable(double amplitude, double frequency, int index) const {
  if (index == 0) return std::nullopt;
  const auto returns = second_ ? pair_returns(amplitude, frequency) : std::optional(index > 0);
  if (returns != true) return returns;
  if (loop_->delay > 0.0) return std::nullopt;  // a loop with delay has infinitely many other roots
  if (loop_->elements.size() > 1) return true;
  // The quasi-linear loop, N acting as Re N + (Im N / w) d/dt: all its other roots must lie in the left half plane.
  const Complex N = gain(amplitude, frequency, 1e-9);
  const Eigen::VectorXcd roots = eigenvalues(quasi_linear(*loop_, main_, N, frequency));
  for (const Complex& root : roots) {
    const bool own =
        std::abs(std::abs(root.imag()) - frequency) < 1e-3 * frequency && std::abs(root.real()) < 1e-3 * frequency;
    if (!own && root.real() > 1e-9 * frequency) return false;
  }
  return true;
}

Eigen::VectorXd FirstHarmonicBalance::linear_state(double amplitude, double frequency, double phase,
                                                   double scale) const {
  const Index n = loop_->states();
  const Eigen::VectorXcd W = outputs(amplitude, frequency, 1e-9);
  Eigen::MatrixXcd M = Complex(0.0, frequency) * Eigen::MatrixXcd::Identity(n, n) - loop_->A.cast<Complex>();
  if (loop_->delay > 0.0) M -= std::exp(Complex(0.0, -frequency * loop_->delay)) * loop_->A_delayed.cast<Complex>();
  const Eigen::VectorXcd X = solve(M, loop_->B.cast<Complex>() * W) * std::polar(1.0, phase);
  bool exact = false;
  return scale * X.imag() + mean_state(amplitude, frequency, 1e-9, exact);
}

LoopState FirstHarmonicBalance::state(double amplitude, double frequency, double scale) const {
  bool exact = false;
  const Port& port = loop_->ports[main_];
  const Eigen::VectorXd mean = mean_state(amplitude, frequency, 1e-9, exact);
  // A loop with a bias and its mirror image start from mirrored states.
  const double bias = (port.C_v * mean + port.c_v * loop_->external).value();
  const double rounding =
      1e-9 * (port.C_v.cwiseAbs() * mean.cwiseAbs() + port.c_v.cwiseAbs() * loop_->external.cwiseAbs()).value();
  return without_history(*loop_, linear_state(amplitude, frequency, 0.0, bias > rounding ? -scale : scale));
}

}  // namespace limcycle
