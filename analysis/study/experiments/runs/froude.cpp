#include "limcycle/analysis/study/experiments/runs/froude.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/harmonics_by_fft.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/sweep.hpp"
#include "limcycle/models/dual.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {
namespace {

constexpr double fast_from = 20.0;  // times the frequency of small swings

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<double> without_mean(std::vector<double> values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
  return values;
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

/// The part of a column after `from` seconds.
std::vector<double> since(const FroudeTrace& trace, const std::vector<double>& column, double from) {
  const auto first = std::ranges::lower_bound(trace.t, from) - trace.t.begin();
  return {column.begin() + first, column.end()};
}

/// Rms of the part of evenly sampled values above w rad/s, through a Hann window (whose mean square is 3/8): leakage
/// from the swing falls with the cube of the distance.
double fast_part(std::vector<double> values, double sample, double w) {
  values = without_mean(std::move(values));
  const auto n = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] *= 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / n));
  const auto lines = harmonics_by_fft(values, 0.0, (static_cast<int>(values.size()) - 1) / 2);
  const double spacing = 2.0 * std::numbers::pi / (n * sample);
  double power = 0.0;
  for (std::size_t k = 1; k < lines.size(); ++k)
    if (static_cast<double>(k) * spacing >= w) power += 0.5 * std::norm(lines[k]) / 0.375;
  return std::sqrt(power);
}

double peak(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

double half_swing(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return 0.5 * (high - low);
}

void compare(FroudeComparison& with, const FroudeComparison& without, const FroudeSetting& setting, double w0,
             double sample) {
  const auto part = [&](const FroudeComparison& c, std::vector<double> FroudeTrace::*column) {
    return since(c.run.trace, c.run.trace.*column, setting.left_out);
  };
  const auto angle = part(with, &FroudeTrace::angle), rubbing = part(with, &FroudeTrace::rubbing);
  const auto angle_0 = part(without, &FroudeTrace::angle), rubbing_0 = part(without, &FroudeTrace::rubbing);
  with.swing = half_swing(angle);
  with.swing_change = with.swing / half_swing(angle_0) - 1.0;
  with.angle_change = rms(difference(angle, angle_0)) / rms(without_mean(angle_0));
  with.rubbing_peak = peak(rubbing);
  with.rubbing_change = rms(difference(rubbing, rubbing_0)) / rms(rubbing_0);
  with.fast_angle = fast_part(angle, sample, fast_from * w0);
  with.fast_normal = fast_part(part(with, &FroudeTrace::normal), sample, fast_from * w0);
  with.fast_rubbing = fast_part(rubbing, sample, fast_from * w0);
}

FroudeOptions options_for(double seconds, const std::function<bool()>& stop) {
  FroudeOptions options;
  options.stop = stop;
  options.duration = seconds;
  options.rtol = 1e-6;
  return options;
}

/// State phi, dphi/dt, z at the start of the comparison.
State start_of(const FroudeSetting& setting, const std::function<bool()>& stop) {
  State start{setting.angle, 0.0, 0.0};
  if (setting.settling == 0.0) return start;
  auto options = options_for(setting.settling, stop);
  options.sample = setting.settling;
  return march_froude(FroudeRigid<double>{setting.pendulum, setting.law}, start, options).last;
}

FroudeRun one_run(const FroudeSetting& setting, const State& start, double clearance,
                  const std::function<bool()>& stop) {
  const auto options = options_for(setting.duration, stop);
  if (clearance == 0.0) return march_froude(FroudeRigid<double>{setting.pendulum, setting.law}, start, options);
  FroudeClearance<double> model{setting.pendulum, setting.contact, setting.law};
  model.pendulum.clearance = clearance;
  return march_froude(model, resting_sleeve(model, start[0], start[1], start[2]), options);
}

double slope_at_shaft(const FroudeSetting& setting) {
  const auto law = recast<LuGre, Dual<1>>(setting.law);
  const double v = std::abs(setting.pendulum.shaft_radius * setting.pendulum.shaft_speed);
  return law.level(Dual<1>::variable(v, 0)).d[0] + setting.law.sigma2;
}

std::string percent(double share) { return short_number(100.0 * share, 2) + " %"; }

std::string sentence(const FroudeSeries& series) {
  const FroudeComparison& widest = series.clearances.back();
  double swing = 0.0, angle = 0.0, rubbing = 0.0;
  for (const auto& c : series.clearances) {
    swing = std::max(swing, std::abs(c.swing_change));
    angle = std::max(angle, c.angle_change);
    rubbing = std::max(rubbing, c.rubbing_change);
  }
  return series.setting.friction + " (slope " + short_number(series.slope, 3) +
         " N s/m at the shaft's speed): play of up to " + short_number(1e3 * widest.clearance, 2) +
         " mm changes the swing by at most " + percent(swing) + ", the angle by " + percent(angle) +
         " and the sliding velocity by " + percent(rubbing) + " (rms); its part above " + short_number(fast_from, 2) +
         " times the swing's frequency is " + short_number(widest.fast_rubbing, 2) + " m/s at the widest" +
         (widest.run.losses > 0 ? ", and the sleeve leaves the shaft " + std::to_string(widest.run.losses) +
                                      " times in " + short_number(series.setting.duration, 2) + " s"
                                : ", and the sleeve never leaves the shaft");
}

std::string conclusion(const std::vector<FroudeSeries>& all) {
  std::string kept, lost;
  for (const auto& series : all) {
    double worst = 0.0;
    for (const auto& c : series.clearances) worst = std::max(worst, std::abs(c.swing_change));
    std::string& list = worst < unchanged_swing ? kept : lost;
    list += (list.empty() ? "" : ", ") + series.setting.name + " (" + percent(worst) + ")";
  }
  std::string text = "play of up to 0.1 mm adds high-frequency oscillation";
  if (!kept.empty()) text += "; it hardly changes the swing on these friction curves: " + kept;
  if (!lost.empty())
    text += "; it does on these: " + lost +
            ", where the falling friction that feeds the swing feeds the rattling of a poorly damped sleeve too, which "
            "then takes the swing away";
  return text;
}

}  // namespace

std::vector<FroudeSetting> froude_settings() {
  FroudeSetting steep;
  steep.pendulum = {
      .mass = 5.0, .arm = 0.2, .inertia = 0.25, .damping = 0.005, .shaft_radius = 0.02, .shaft_speed = 4.0};
  steep.contact = {.stiffness = 1e10, .exponent = 1.5, .dissipation = 2.0};
  LuGre<double>& law = steep.law;
  law.Fs = law.Fs_minus = 17.0;
  law.Fc = law.Fc_minus = 7.4;
  law.vs = 0.1;
  law.sigma0 = 1e5;
  law.sigma1 = 100.0;
  law.sigma2 = 1.0;
  FroudeSetting slight = steep, flat = steep;
  steep.name = "steep";
  steep.friction = "friction that falls steeply, as hunting needs it";
  steep.settling = 80.0;
  slight.name = "slight";
  slight.friction = "friction that falls slightly";
  slight.law.Fs = slight.law.Fs_minus = 8.0;
  flat.name = "flat";
  flat.friction = "friction that does not fall";
  flat.law.Fs = flat.law.Fs_minus = flat.law.Fc;
  FroudeSetting damped = steep;
  damped.name = "steep, damped";
  damped.friction = "friction that falls steeply, in a contact that damps ten times as well";
  damped.contact.dissipation = 20.0;
  return {flat, slight, damped, steep};
}

FroudeResult froude_experiment(const std::vector<FroudeSetting>& settings, const std::vector<double>& clearances,
                               int threads, const std::function<bool()>& stop) {
  FroudeResult result;
  for (const auto& setting : settings) {
    FroudeSeries series;
    series.setting = setting;
    const auto& p = setting.pendulum;
    series.small_frequency = std::sqrt(p.mass * p.gravity * p.arm / p.inertia);
    series.slope = slope_at_shaft(setting);
    series.clearances.resize(clearances.size() + 1);
    for (std::size_t k = 0; k < clearances.size(); ++k) series.clearances[k + 1].clearance = clearances[k];
    result.series.push_back(std::move(series));
  }
  std::vector<State> starts;
  starts.reserve(settings.size());
  for (const auto& setting : settings) starts.push_back(start_of(setting, stop));
  const std::size_t columns = clearances.size() + 1, runs = settings.size() * columns;
  SweepOptions each;
  each.threads = threads;
  const auto one = [&](std::size_t i) {
    const std::size_t at = settings.size() - 1 - i / columns;  // the longest first
    auto& comparison = result.series[at].clearances[i % columns];
    comparison.run = one_run(settings[at], starts[at], comparison.clearance, stop);
  };
  run_each(runs, one, each);
  for (auto& series : result.series) {
    for (const auto& c : series.clearances)
      if (c.run.status != Status::converged) result.status = c.run.status;
    if (result.status != Status::converged) return result;
    for (auto& c : series.clearances)
      compare(c, series.clearances.front(), series.setting, series.small_frequency, FroudeOptions{}.sample);
    series.finding = sentence(series);
  }
  result.finding = conclusion(result.series);
  return result;
}

}  // namespace limcycle
