#include "limcycle/analysis/frequency/harmonic_balance/harmonic_balance.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "limcycle/analysis/frequency/describing_function/argument_error.hpp"
#include "limcycle/analysis/frequency/harmonic_balance/balance_newton.hpp"
#include "limcycle/analysis/frequency/harmonic_balance/balance_start.hpp"
#include "limcycle/models/measured/plants_of_loop.hpp"

namespace limcycle {

namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXcd;

void validate(const Loop& loop, const HarmonicGuess& guess, const HarmonicBalanceOptions& options) {
  const auto elements = std::ssize(loop.elements);
  if (elements == 0) refuse("harmonic balance", "number of elements", 0.0, "must be at least 1");
  if (options.max_harmonics < 1 || options.max_harmonics > 400)
    refuse("harmonic balance", "max_harmonics", options.max_harmonics, "must lie in 1..400");
  if (!(options.accuracy >= 1e-12 && options.accuracy <= 1e-3))
    refuse("harmonic balance", "accuracy", options.accuracy, "must lie in 1e-12..1e-3");
  if (!(options.tail > 0.0)) refuse("harmonic balance", "tail", options.tail, "must be positive");
  if (options.max_evaluations < 1)
    refuse("harmonic balance", "max_evaluations", static_cast<double>(options.max_evaluations), "must be at least 1");
  if (options.max_iterations < 1)
    refuse("harmonic balance", "max_iterations", options.max_iterations, "must be at least 1");
  if (!(guess.frequency > 0.0) || !std::isfinite(guess.frequency))
    refuse("harmonic balance", "frequency of the guess", guess.frequency, "must be positive and finite");
  const auto given = guess.inputs.empty() ? guess.first.size() : std::ssize(guess.inputs);
  if (given != elements)
    refuse("harmonic balance", "number of inputs of the guess", static_cast<double>(given), "must be that of elements");
  if (guess.mean.size() != 0 && guess.mean.size() != elements)
    refuse("harmonic balance", "number of means of the guess", static_cast<double>(guess.mean.size()),
           "must be that of elements");
  for (const auto& series : guess.inputs)
    if (series.size() < 2 || series.size() != guess.inputs.front().size())
      refuse("harmonic balance", "number of harmonics of the guess", static_cast<double>(series.size()) - 1.0,
             "must be at least 1 and the same for all elements");
  const auto finite = [](const auto& list) {
    return std::all_of(list.begin(), list.end(), [](const auto& series) { return series.allFinite(); });
  };
  if (!guess.first.allFinite() || !guess.mean.allFinite() || !finite(guess.inputs))
    throw std::invalid_argument("harmonic balance: the guess holds a number that is not finite");
  const Complex main = guess.inputs.empty() ? guess.first(elements - 1) : guess.inputs.back()(1);
  if (!(std::abs(main) > 0.0) || !std::isfinite(std::abs(main)))
    refuse("harmonic balance", "first harmonic of the guess", std::abs(main), "must be positive and finite");
  if (!options.half_wave_symmetric) return;
  for (const auto& element : loop.elements)
    if (!element.odd()) throw std::invalid_argument("harmonic balance: half_wave_symmetric = true needs odd elements");
}

/// The numbers of harmonics to try; the last is the largest allowed.
std::vector<int> stages(int from, int most, bool half_wave) {
  std::vector<int> list;
  if (half_wave && most % 2 == 0) --most;
  for (int h : {1, 3, 5, 9, 15, 25, 45, 75, 125, 201, 335})
    if (h >= from && h < most) list.push_back(h);
  list.push_back(std::max(most, 1));
  return list;
}

class Search {
 public:
  Search(const Loop& loop, const HarmonicGuess& guess, const HarmonicBalanceOptions& options)
      : loop_(loop), guess_(guess), options_(options), equations_(loop, options.half_wave_symmetric) {}

  HarmonicBalance run() {
    quadrature(stage_level);
    if (const Status status = balance_start(loop_, equations_, guess_, options_.half_wave_symmetric, point_);
        status != Status::converged)
      return failed(status, "an element has no periodic answer to the guess");
    const int given = static_cast<int>(point_.inputs.front().size()) - 1;
    int failures = 0;
    for (const int H : stages(given, std::max(options_.max_harmonics, given), options_.half_wave_symmetric)) {
      const BalanceSolution now = solve(H);
      if (now.status == Status::interrupted) return ended();
      if (now.status != Status::converged) {
        last_ = now;
        // A low order may have no balance although a higher one has; after a success, two failures are enough to stop.
        if (++failures > (found_ ? 1 : 4)) break;
        continue;
      }
      failures = 0;
      point_ = now.point;
      outputs_ = now.outputs;
      residual_ = now.residual;
      measure_change();
      found_ = true;
      if (H >= std::min(5, options_.max_harmonics) && tail() <= options_.tail) break;
    }
    return found_ ? polish(failures) : failed(last_.status, no_balance());
  }

 private:
  static constexpr int stage_level = 2;

  void quadrature(int level) { equations_.set_quadrature(level, std::min(1e-10, 1e-3 * options_.accuracy)); }

  /// The balance with H harmonics, begun from the present point with the orders it lacks as they pass through the loop.
  BalanceSolution solve(int H) {
    BalancePoint point = point_;
    const auto had = static_cast<int>(point.inputs.front().size()) - 1;
    BalanceOutputs outputs = equations_.outputs(point, H);
    if (outputs.status != Status::converged) return {outputs.status, point, outputs, 0.0};
    for (auto& series : point.inputs) series.conservativeResizeLike(VectorXcd::Zero(H + 1));
    for (int n = had + 1; n <= H; ++n) {
      if (options_.half_wave_symmetric && n % 2 == 0) continue;
      VectorXcd W(std::ssize(loop_.elements));
      for (Index k = 0; k < W.size(); ++k) W(k) = outputs.harmonics[static_cast<std::size_t>(k)](n);
      const VectorXcd X = equations_.response(n, point.frequency) * W;
      for (Index k = 0; k < W.size(); ++k) point.inputs[static_cast<std::size_t>(k)](n) = X(k);
    }
    equations_.set_reference(point, outputs);
    const double loose = std::clamp(0.01 * options_.tail, 1e-8, 1e-4);
    return newton(point, std::max(options_.accuracy, loose));
  }

  BalanceSolution newton(const BalancePoint& point, double tolerance) {
    return solve_balance(equations_, point,
                         {tolerance, options_.max_iterations, [this] { return spent() || stopped(); }});
  }

  bool spent() const { return equations_.evaluations() >= options_.max_evaluations; }
  bool stopped() { return stopped_ = stopped_ || (options_.stop && options_.stop()); }

  /// Stopped by the caller or by the limit of evaluations.
  HarmonicBalance ended() const {
    if (stopped_) return finish(Status::interrupted, "stopped on request");
    std::ostringstream why;
    why << "the limit of " << options_.max_evaluations << " evaluations was reached before "
        << (found_ ? "the tail was small and the equations solved to the wanted accuracy" : "a balance was found");
    return finish(found_ ? Status::incomplete : Status::max_iterations, why.str());
  }

  /// Solves to the wanted accuracy on panels fine enough that finer ones agree.
  HarmonicBalance polish(int failures) {
    const int first = options_.accuracy >= 1e-7 ? 2 : options_.accuracy >= 1e-10 ? 3 : 4;
    equations_.set_reference(point_, outputs_);
    bool solved = false;
    for (int level = first; level < ElementHarmonics::finest && !solved; ++level) {
      quadrature(level);
      const BalanceSolution now = newton(point_, 0.5 * options_.accuracy);
      if (now.status == Status::interrupted) return ended();
      if (now.status == Status::converged) {
        point_ = now.point;
        outputs_ = now.outputs;
      }
      quadrature(level + 1);
      const BalanceOutputs finer = equations_.outputs(point_, equations_.orders());
      if (finer.status != Status::converged) continue;
      residual_ = equations_.residual(point_, finer).cwiseAbs().maxCoeff();
      solved = residual_ <= options_.accuracy;
    }
    return verdict(solved, failures);
  }

  HarmonicBalance verdict(bool solved, int failures) const {
    if (solved && tail() <= options_.tail) return finish(Status::converged, "");
    const auto H = point_.inputs.front().size() - 1;
    const char* const more = failures > 0 ? "; with more of them no balance was found" : "";
    std::ostringstream why;
    why.precision(2);
    if (!solved)
      why << "the equations are solved to " << residual_ << " of their size only, not to the wanted "
          << options_.accuracy;
    else if (H == 1)
      why << "one harmonic does not show how small the others are" << more;
    else
      why << "with " << H << " harmonics the last of them are " << tail() << " of the first, not below the wanted "
          << options_.tail
          << ": the motion has corners (sticking, jumps) that harmonics follow slowly, or too few were allowed" << more;
    return finish(Status::incomplete, why.str());
  }

  std::string no_balance() const {
    std::ostringstream why;
    why.precision(2);
    why << "no balance was found from this guess: the equations stay apart by " << last_.residual << " of their size";
    return why.str();
  }

  HarmonicBalance failed(Status status, std::string why) const {
    HarmonicBalance result;
    result.status = status;
    result.why = std::move(why);
    result.evaluations = equations_.evaluations();
    return result;
  }

  VectorXcd output_series(const BalanceMeans& means) const {
    const auto H = static_cast<int>(point_.inputs.front().size()) - 1;
    VectorXcd y = VectorXcd::Zero(H + 1), W(std::ssize(loop_.elements));
    y(0) = {0.0, loop_.output_origin + (loop_.C_y * means.state).value()};
    for (int n = 1; n <= H; n += options_.half_wave_symmetric ? 2 : 1) {
      for (Index k = 0; k < W.size(); ++k) W(k) = outputs_.harmonics[static_cast<std::size_t>(k)](n);
      y(n) = (loop_.output_response(n * point_.frequency) * W).value();
    }
    return y;
  }

  /// Change of the frequency and of y's first harmonic by the orders that were added last.
  void measure_change() {
    const double frequency = point_.frequency;
    const double first = std::abs(output_series(equations_.means(point_.mean_outputs, point_.free))(1));
    if (found_) change_ = std::max(std::abs(frequency / frequency_ - 1.0), std::abs(first / first_ - 1.0));
    frequency_ = frequency;
    first_ = first;
  }

  /// Tail of y or of the rubbing displacement, the larger: a lag between the two filters the harmonics of y, not those
  /// that act on the friction.
  double tail() const {
    const double of_y = tail_of(output_series(equations_.means(point_.mean_outputs, point_.free)));
    return loop_.ports.back().rubs ? std::max(of_y, tail_of(point_.inputs.back())) : of_y;
  }

  static double tail_of(const VectorXcd& y) {
    const Index H = y.size() - 1, from = std::max<Index>(2, 2 * H / 3 + 1);
    const double first = std::abs(y(1));
    if (H == 1 || !(first > 0.0)) return 1.0;
    return y.tail(H + 1 - from).cwiseAbs().maxCoeff() / first;
  }

  HarmonicBalance finish(Status status, std::string why) const {
    HarmonicBalance result = failed(status, std::move(why));
    if (!found_) return result;
    const BalanceMeans means = equations_.means(point_.mean_outputs, point_.free);
    result.frequency = point_.frequency;
    result.harmonics = static_cast<int>(point_.inputs.front().size()) - 1;
    result.inputs = point_.inputs;
    result.outputs = outputs_.harmonics;
    for (std::size_t k = 0; k < result.inputs.size(); ++k)
      result.inputs[k](0) = {0.0, means.inputs(static_cast<Index>(k))};
    result.mean_rates = means.rates;
    result.y = output_series(means);
    result.first_harmonic = std::abs(result.y(1));
    result.offset = result.y(0).imag();
    result.amplitude = half_peak_to_peak(result.y);
    result.tail = tail();
    result.change = change_;
    result.residual = residual_;
    return result;
  }

  static double half_peak_to_peak(const VectorXcd& y) {
    if (y.tail(y.size() - 1).norm() == 0.0) return 0.0;
    const PrescribedHarmonics motion(y, 1.0, 0.0, false);
    double low = infinite, high = -infinite;
    for (int i = 1; i <= motion.stops(); ++i) {
      const double value = motion.at(i, 0.0).in.x;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    return 0.5 * (high - low);
  }

  const Loop& loop_;
  const HarmonicGuess& guess_;
  const HarmonicBalanceOptions& options_;
  BalanceEquations equations_;
  BalancePoint point_;
  BalanceOutputs outputs_;
  BalanceSolution last_;
  double residual_ = 0.0, change_ = 1.0;
  double frequency_ = 0.0, first_ = 0.0;  ///< of the last number of harmonics that had a balance
  bool found_ = false, stopped_ = false;
};

}  // namespace

HarmonicBalance harmonic_balance(const Loop& loop, const HarmonicGuess& guess, const HarmonicBalanceOptions& options) {
  if (!loop.measured.empty()) return harmonic_balance(with_fits(loop), guess, options);
  validate(loop, guess, options);
  return Search(loop, guess, options).run();
}

}  // namespace limcycle
