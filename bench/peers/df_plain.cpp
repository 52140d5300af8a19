/// @file
/// The plain describing-function programs: integrate a few periods from rest with Boost.Odeint, sample the last one,
/// FFTW. On 25 points, each with the setting that is cheapest for it at an error of 1e-6 and of 1e-9, and all with the
/// single setting that solves the most of them.
///   df_plain REFERENCE
#include <fftw3.h>

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <memory>

#include "limcycle/bench/bristle.hpp"
#include "limcycle/bench/measure.hpp"

namespace {

namespace odeint = boost::numeric::odeint;
using State = std::array<double, 1>;
using Bristle = bench::Bristle<double>;
constexpr double period = 6.283185307179586;

/// First harmonic of uniform samples over one period; the plan is made in advance.
class FirstHarmonic {
 public:
  explicit FirstHarmonic(int size)
      : samples_(fftw_alloc_real(static_cast<std::size_t>(size)), fftw_free),
        spectrum_(fftw_alloc_complex(static_cast<std::size_t>(size / 2 + 1)), fftw_free),
        plan_(fftw_plan_dft_r2c_1d(size, samples_.get(), spectrum_.get(), FFTW_ESTIMATE), fftw_destroy_plan),
        size_(size) {}
  double* samples() { return samples_.get(); }
  int size() const { return size_; }
  /// b1 + j a1.
  std::complex<double> operator()() {
    fftw_execute(plan_.get());
    const double scale = 2.0 / size_;
    return {-scale * spectrum_.get()[1][1], scale * spectrum_.get()[1][0]};
  }

 private:
  std::unique_ptr<double, void (*)(void*)> samples_;
  std::unique_ptr<fftw_complex, void (*)(void*)> spectrum_;
  std::unique_ptr<fftw_plan_s, void (*)(fftw_plan)> plan_;
  int size_;
};

struct Setting {
  int periods;
  int samples;       ///< of the last period; rk4: steps a period
  double tolerance;  ///< dopri5
};

std::complex<double> dopri5(const Bristle& bristle, const Setting& setting, FirstHarmonic& transform) {
  const auto rate = [&](const State& f, State& d, double phase) { d[0] = bristle.rate(f[0], phase); };
  auto stepper = odeint::make_dense_output(setting.tolerance, setting.tolerance, odeint::runge_kutta_dopri5<State>());
  stepper.initialize(State{0.0}, 0.0, 1e-3);
  const double begin = period * (setting.periods - 1);
  State f{};
  for (int k = 0; k < transform.size(); ++k) {
    const double phase = begin + period * k / transform.size();
    while (stepper.current_time() < phase) stepper.do_step(rate);
    stepper.calc_state(phase, f);
    transform.samples()[k] = bristle.force(f[0], phase);
  }
  return transform() / bristle.amplitude;
}

std::complex<double> rk4(const Bristle& bristle, const Setting& setting, FirstHarmonic& transform) {
  const auto rate = [&](const State& f, State& d, double phase) { d[0] = bristle.rate(f[0], phase); };
  odeint::runge_kutta4<State> stepper;
  State f{0.0};
  const double h = period / transform.size();
  for (int p = 0; p < setting.periods; ++p)
    for (int k = 0; k < transform.size(); ++k) {
      const double phase = h * k;
      if (p + 1 == setting.periods) transform.samples()[k] = bristle.force(f[0], phase);
      stepper.do_step(rate, f, phase, h);
    }
  return transform() / bristle.amplitude;
}

using Program = std::complex<double> (*)(const Bristle&, const Setting&, FirstHarmonic&);

/// Settings in order of cost, with at most 2^20 samples and 2e7 of them over all periods.
std::vector<Setting> settings(bool adaptive, int periods) {
  std::vector<Setting> all;
  for (int size = 64; size <= (1 << 20) && (adaptive || double(size) * periods < 2e7); size *= 2) {
    if (!adaptive) all.push_back({periods, size, 0.0});
    for (const double tolerance : {1e-5, 1e-7, 1e-9, 1e-11})
      if (adaptive) all.push_back({periods, size, tolerance});
  }
  return all;
}

/// Result of one setting at one point.
struct Sample {
  double error, seconds;
};

/// Least time of three runs, of one if it is long.
Sample sample(Program program, const Setting& setting, const bench::DfReference& point) {
  const Bristle bristle{point.amplitude, point.frequency};
  FirstHarmonic transform(setting.samples);
  Sample found{0.0, INFINITY};
  for (int i = 0; i < 3 && (i == 0 || found.seconds < 0.03); ++i) {
    const double begin = bench::cpu_seconds();
    const std::complex<double> gain = program(bristle, setting, transform);
    found.seconds = std::min(found.seconds, bench::cpu_seconds() - begin);
    found.error = std::abs(gain / point.gain - 1.0);
  }
  return found;
}

/// Points solved, time of a point, and largest error over those solved.
struct Tally {
  int solved = 0;
  double seconds = 0.0, error = 0.0;
};

void print(const std::string& problem, const std::string& contender, const std::string& setting, const Tally& tally,
           std::size_t points) {
  bench::print({"df", problem, contender, setting, tally.solved ? tally.error : -1.0, tally.seconds, tally.solved,
                std::to_string(tally.solved) + " of " + std::to_string(points) + " solved"});
}

/// Each point with the setting that is cheapest for it, which is not known in advance. Mean time over those solved.
void best_for_each(const std::string& name, double target, const std::vector<std::vector<Sample>>& samples,
                   const std::vector<bench::DfReference>& points) {
  Tally tally;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Sample* best = nullptr;
    for (const Sample& sample : samples[i])
      if (sample.error <= target && (best == nullptr || sample.seconds < best->seconds)) best = &sample;
    if (best == nullptr) {
      char problem[80];
      std::snprintf(problem, sizeof problem, "point A=%.2e w=%.2e to %.0e", points[i].amplitude, points[i].frequency,
                    target);
      bench::print({"df", problem, name, "any", -1.0, 0.0, 0, "no setting is right to that"});
      continue;
    }
    ++tally.solved;
    tally.seconds += best->seconds;
    tally.error = std::max(tally.error, best->error);
  }
  if (tally.solved) tally.seconds /= tally.solved;
  print("25 points to " + bench::short_power(target), name, "best for each point", tally, points.size());
}

/// The one setting that solves the most points, and of these the cheapest: a program with fixed settings. Mean time
/// over all points.
void one_for_all(const std::string& name, double target, const std::vector<std::vector<Sample>>& samples,
                 const std::vector<Setting>& ladder) {
  Tally best;
  std::string setting;
  for (std::size_t k = 0; k < ladder.size(); ++k) {
    Tally tally;
    for (const auto& of_point : samples) {
      tally.seconds += of_point[k].seconds / static_cast<double>(samples.size());
      if (!(of_point[k].error <= target)) continue;
      ++tally.solved;
      tally.error = std::max(tally.error, of_point[k].error);
    }
    if (tally.solved < best.solved || (tally.solved == best.solved && best.solved && tally.seconds > best.seconds))
      continue;
    best = tally;
    setting = std::to_string(ladder[k].samples) + " samples";
    if (ladder[k].tolerance > 0.0) setting += " tolerance " + bench::short_power(ladder[k].tolerance);
  }
  print("25 points to " + bench::short_power(target), name + " one setting", setting, best, samples.size());
}

void measure(const std::string& name, Program program, const std::vector<Setting>& ladder,
             const std::vector<bench::DfReference>& points) {
  std::vector<std::vector<Sample>> samples(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (const Setting& setting : ladder) samples[i].push_back(sample(program, setting, points[i]));
  for (const double target : {1e-6, 1e-9}) {
    best_for_each(name, target, samples, points);
    one_for_all(name, target, samples, ladder);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  auto points = bench::read_df_reference(arguments[1]);
  points.erase(std::remove_if(points.begin(), points.end(), [](const auto& p) { return p.index >= 0; }), points.end());
  measure("odeint dopri5 + FFTW 3 periods", dopri5, settings(true, 3), points);
  measure("odeint dopri5 + FFTW 40 periods", dopri5, settings(true, 40), points);
  measure("odeint rk4 + FFTW 5 periods", rk4, settings(false, 5), points);
  measure("odeint rk4 + FFTW 40 periods", rk4, settings(false, 40), points);
}
