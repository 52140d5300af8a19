#pragma once
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle::sample {

/// An artificial stick-slip cycle in closed form: stuck for half the period (y constant), slipping along half cosines
/// in between.
inline Trace stick_slip_trace(double amplitude, double period, int n = 4001) {
  Trace trace;
  for (int i = 0; i < n; ++i) {
    const double t = period * i / (n - 1);
    const double phase = 4.0 * t / period;  // quarters: stuck up, slip down, stuck down, slip up
    const int quarter = std::min(static_cast<int>(phase), 3);
    const double along = std::numbers::pi * (phase - quarter);
    const double speed = std::numbers::pi * 4.0 / period;
    const bool slips = quarter % 2 == 1;
    const double side = quarter < 2 ? 1.0 : -1.0;
    trace.t.push_back(t);
    trace.y.push_back(amplitude * side * (slips ? std::cos(along) : 1.0));
    trace.rate.push_back(slips ? -amplitude * side * speed * std::sin(along) : 0.0);
    trace.output.push_back(slips ? -side : side * (1.0 - 2.0 * (phase - quarter)));
  }
  trace.input = trace.y;
  trace.velocity = trace.rate;
  return trace;
}

inline Cycle hunting_cycle() {
  Cycle cycle;
  cycle.amplitude = 0.063903123456;
  cycle.first_harmonic = 0.0712;
  cycle.period = 24.436786455993;
  cycle.offset = 1e-14;
  cycle.stable = true;
  cycle.multipliers = {{0.0095, -0.001}, {0.0, 0.0}};
  cycle.sticking_fraction = 0.5;
  cycle.method = "shooting";
  cycle.error = 1e-10;
  cycle.residual = 3e-12;
  cycle.half_wave_symmetric = true;
  cycle.trace = stick_slip_trace(cycle.amplitude, cycle.period);
  return cycle;
}

/// Report on a hunting servo for which the describing function finds nothing.
inline PredictReport hunting() {
  PredictReport report;
  report.search = {1e-6, 1.0, 0.01, 1000.0};
  report.cycles = {hunting_cycle()};
  report.missed = {{"describing-function", 0}};
  report.outcomes = {{"y(0) = 1", Outcome::cycle, "it settles", 0, stick_slip_trace(1.0, 24.0)},
                     {"y(0) = 0.1", Outcome::cycle, "", 0, {}}};
  for (const double w : {0.01, 1.0, 100.0}) {
    report.nyquist.frequency.push_back(w);
    report.nyquist.G.push_back(1.0 / std::complex<double>(1.0, w));
  }
  report.describing_function = true;
  report.nyquist.family_amplitude = {0.1, 1.0};
  report.nyquist.family_frequency = {1.0};
  report.nyquist.minus_inverse_N = {{{0.0, 0.1}, {0.0, 1.0}}};
  report.notes = {"a note"};
  return report;
}

/// Two predictions, one near a cycle and one that is false.
inline PredictReport relay() {
  PredictReport report = hunting();
  report.missed.clear();
  auto& cycle = report.cycles[0];
  cycle.amplitude = 0.65831343;
  cycle.first_harmonic = 0.65;
  cycle.period = 2.0 * std::numbers::pi;
  cycle.sticking_fraction = 0.0;
  cycle.method = "exact";
  report.predictions = {
      {"describing-function", 0.637, 1.01, 0.637, 1e-12, true, Verdict::confirmed, 0, "within 5 %"},
      {"describing-function", 0.1, 7.0, 0.1, 2e-12, std::nullopt, Verdict::wrong, std::nullopt, "it comes to rest"}};
  return report;
}

/// The same with trust indicators: a proved band for the first prediction, a heuristic one without ends for the other.
inline PredictReport trusted() {
  PredictReport report = relay();
  Trust good;
  good.filter_ratio = 0.0075512345;
  good.harmonic_residual = 0.0081;
  good.band = {BandKind::rigorous,  BandVerdict::proved, {0.98, 1.03},
               {0.6, 0.7},          {1.2, 1.4},          {{0.98, {-0.8, 0.1}, 0.05}, {1.03, {-0.81, 0.0}, 0.06}},
               "crossed completely"};
  good.sentence = "the loop filters the harmonics well: a cycle within 6 % of it is proved";
  Trust poor;
  poor.filter_ratio = 0.2;
  poor.worst_harmonic = 5;
  poor.harmonic_residual = 0.95;
  poor.sticking_fraction = 0.01;
  poor.band.frequency = poor.band.amplitude = poor.band.input_amplitude = {0.0, infinite};
  poor.band.why = "no bounded band";
  poor.sentence = "the loop hardly filters the fifth harmonic: amplitude and frequency may be far off";
  report.predictions[0].trust = good;
  report.predictions[1].trust = poor;
  return report;
}

/// A report without predictions, with the absence of oscillations requested.
inline PredictReport without_roots(BandVerdict verdict) {
  PredictReport report = hunting();
  report.cycles.clear();
  report.missed.clear();
  report.absence = Absence{verdict, {1e-3, 10.0, 0.01, 100.0}, {}, "no error disc meets -Psi"};
  if (verdict == BandVerdict::undecided) {
    report.absence->undecided = {{0.01, 0.4}, {0.5, 0.6}};
    report.absence->why = "an oscillation is not excluded between 0.01 and 0.6 rad/s";
  }
  return report;
}

}  // namespace limcycle::sample
