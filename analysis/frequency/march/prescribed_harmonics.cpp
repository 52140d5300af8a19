#include "limcycle/analysis/frequency/march/prescribed_harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "limcycle/analysis/frequency/describing_function/argument_error.hpp"

namespace limcycle {

namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

}  // namespace

double series_value(const Eigen::VectorXcd& coefficients, double phase) {
  double value = 0.0;
  for (Eigen::Index n = 0; n < coefficients.size(); ++n)
    value += (coefficients(n) * std::polar(1.0, static_cast<double>(n) * phase)).imag();
  return value;
}

PrescribedHarmonics::PrescribedHarmonics(const Eigen::VectorXcd& input, double frequency, double mean_rate,
                                         bool half_wave)
    : frequency_(frequency), drift_(half_wave ? 0.0 : mean_rate), half_wave_(half_wave), stride_(half_wave ? 2 : 1) {
  if (!(frequency > 0.0) || !std::isfinite(frequency))
    refuse("motion of several harmonics", "frequency", frequency, "must be positive and finite");
  if (!std::isfinite(mean_rate)) refuse("motion of several harmonics", "mean rate", mean_rate, "must be finite");
  for (Eigen::Index n = 0; n < input.size(); ++n)
    if (!std::isfinite(input(n).real()) || !std::isfinite(input(n).imag()))
      refuse("motion of several harmonics", "order of a coefficient that is not finite", static_cast<double>(n), "");
  if (!half_wave && input.size() > 0) mean_ = input(0).imag();
  double size = 0.0;
  for (Eigen::Index n = first_; n < input.size(); n += stride_) {
    const auto order = static_cast<double>(n);
    input_.push_back(input(n));
    order_.push_back(order);
    size = std::max(size, std::abs(input(n)));
    bend_ += frequency * order * order * order * std::abs(input(n));
  }
  if (size == 0.0) refuse("motion of several harmonics", "largest harmonic of the input", size, "must be positive");
  place_anchors();
}

PrescribedHarmonics::Rates PrescribedHarmonics::rates(double phase) const {
  const Complex turn = std::polar(1.0, stride_ * phase);
  Complex at = std::polar(1.0, phase);
  Rates result{drift_ / frequency_, 0.0};
  for (std::size_t i = 0; i < input_.size(); ++i) {
    const double n = order_[i], re = input_[i].real() * at.real() - input_[i].imag() * at.imag(),
                 im = input_[i].real() * at.imag() + input_[i].imag() * at.real();
    result.v += n * re;
    result.slope -= n * n * im;
    at = {at.real() * turn.real() - at.imag() * turn.imag(), at.real() * turn.imag() + at.imag() * turn.real()};
  }
  return result;
}

/// Zero of the rate (or of its slope) between two phases where it differs in sign: regula falsi (Illinois) with
/// bisections in between.
double PrescribedHarmonics::root(double low, double high, bool of_slope) const {
  const auto value = [&](double phase) { return of_slope ? rates(phase).slope : rates(phase).v; };
  double f_low = value(low), f_high = value(high);
  const double tiny = 2e-16 * std::max(1.0, std::abs(high));
  int side = 0;
  for (int k = 0; k < 120 && high - low > tiny; ++k) {
    double at = k % 4 == 3 ? 0.5 * (low + high) : (low * f_high - high * f_low) / (f_high - f_low);
    if (!(at > low && at < high)) at = 0.5 * (low + high);
    if (!(at > low && at < high)) break;
    const double f = value(at);
    if (f == 0.0) return at;
    if ((f < 0.0) == (f_high < 0.0)) {
      high = at;
      f_high = f;
      if (side == -1) f_low *= 0.5;
      side = -1;
    } else {
      low = at;
      f_low = f;
      if (side == 1) f_high *= 0.5;
      side = 1;
    }
  }
  return 0.5 * (low + high);
}

/// Reversals and phases of least speed in (from, to], by a scan with 8 cells a period of the highest harmonic. Where
/// the rate turns back towards zero within a cell its extremum is located, so that a pair of reversals is not stepped
/// over.
void PrescribedHarmonics::find_stops(double from, double to, std::vector<double>& reversals,
                                     std::vector<double>& slowest) const {
  const int cells = static_cast<int>(std::ceil((to - from) / (2.0 * pi) * (8.0 * order_.back() + 16.0)));
  const auto forward = [](double v) { return v >= 0.0; };
  double left = from;
  Rates a = rates(left);
  for (int i = 1; i <= cells; ++i) {
    const double right = from + (to - from) * i / cells;
    const Rates b = rates(right);
    if (forward(a.v) != forward(b.v)) {
      reversals.push_back(root(left, right, false));
    } else if (forward(a.v) ? a.slope < 0.0 && b.slope > 0.0 : a.slope > 0.0 && b.slope < 0.0) {
      const double extreme = root(left, right, true);
      if (forward(rates(extreme).v) != forward(a.v)) {
        reversals.push_back(root(left, extreme, false));
        reversals.push_back(root(extreme, right, false));
      } else {
        slowest.push_back(extreme);
      }
    }
    left = right;
    a = b;
  }
}

PrescribedHarmonics::Anchor PrescribedHarmonics::anchor(double phase, bool reversal) const {
  Anchor a;
  a.phase = phase;
  a.sine = std::sin(phase);
  a.cosine = std::cos(phase);
  a.level = mean_;
  a.re.resize(input_.size());
  a.im.resize(input_.size());
  double v = drift_ / frequency_;
  for (std::size_t i = 0; i < input_.size(); ++i) {
    const Complex turned = input_[i] * std::polar(1.0, order_[i] * phase);
    a.re[i] = turned.real();
    a.im[i] = turned.imag();
    a.level += turned.imag();
    v += order_[i] * turned.real();
  }
  a.rate = reversal ? 0.0 : frequency_ * v;
  return a;
}

void PrescribedHarmonics::place_anchors() {
  const double length = half_wave_ ? pi : 2.0 * pi;
  std::vector<double> reversals, slowest;
  find_stops(0.0, length, reversals, slowest);
  struct Stop {
    double phase;
    bool reversal;
  };
  std::vector<Stop> stops;
  stops.reserve(reversals.size() + slowest.size() + 1);
  for (const double phase : reversals) stops.push_back({phase, true});
  for (const double phase : slowest) stops.push_back({phase, false});
  if (stops.empty()) stops.push_back({0.0, false});  // not reached: a rate that oscillates has an extremum
  std::sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.phase < b.phase; });
  // The period begins at the first reversal; without reversals where the motion is slowest.
  auto begin = std::find_if(stops.begin(), stops.end(), [](const Stop& s) { return s.reversal; });
  if (begin == stops.end())
    begin = std::min_element(stops.begin(), stops.end(), [this](const Stop& a, const Stop& b) {
      return std::abs(rates(a.phase).v) < std::abs(rates(b.phase).v);
    });
  const auto before = begin - stops.begin();
  for (auto i = 0; i < before; ++i) stops[static_cast<std::size_t>(i)].phase += length;
  std::rotate(stops.begin(), begin, stops.end());
  anchors_.push_back(anchor(0.0, false));
  for (const Stop& stop : stops) anchors_.push_back(anchor(stop.phase, stop.reversal));
  if (half_wave_)
    for (const Stop& stop : stops) anchors_.push_back(anchor(stop.phase + pi, stop.reversal));
  anchors_.push_back(anchors_[1]);
  anchors_.back().phase += 2.0 * pi;
}

MotionNode PrescribedHarmonics::at(int anchor, double local) const {
  const Anchor& a = of(anchor);
  const double half_sine = std::sin(0.5 * local), half_cosine = std::cos(0.5 * local);
  const double sine = 2.0 * half_sine * half_cosine, versine = 2.0 * half_sine * half_sine;
  // Sine and versine (1 - cosine) of the step from one order to the next.
  const double step_sine = stride_ == 1 ? sine : 2.0 * sine * (1.0 - versine);
  const double step_versine = stride_ == 1 ? versine : 2.0 * sine * sine;
  double s = sine, v = versine, x = 0.0, rate = 0.0, slope = 0.0;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    x += s * a.re[i] - v * a.im[i];
    rate -= order_[i] * (s * a.im[i] + v * a.re[i]);
    slope -= order_[i] * order_[i] * (a.im[i] + s * a.re[i] - v * a.im[i]);
    const double next = s - s * step_versine + step_sine - v * step_sine;
    v = v + step_versine - v * step_versine + s * step_sine;
    s = next;
  }
  MotionNode node;
  node.sine = a.sine - a.sine * versine + a.cosine * sine;
  node.cosine = a.cosine - a.cosine * versine - a.sine * sine;
  node.in.x = a.level + x + (drift_ == 0.0 ? 0.0 : drift_ * (a.phase + local) / frequency_);
  node.in.v = a.rate + frequency_ * rate;
  node.in.drive = std::copysign(infinite, node.in.v);
  node.slope = frequency_ * slope;
  return node;
}

double PrescribedHarmonics::least_speed() const {
  double least = infinite;
  for (int i = 1; i <= stops(); ++i) least = std::min(least, std::abs(rate(i)));
  return least;
}

double PrescribedHarmonics::layer(int anchor, const Scales& scales) const {
  const Anchor& a = of(anchor);
  double slope = 0.0;
  for (std::size_t i = 0; i < order_.size(); ++i) slope += order_[i] * order_[i] * a.im[i];
  slope = frequency_ * std::abs(slope);
  const double way = scales.displacement * frequency_;
  double width = std::min({scales.velocity / slope, std::sqrt(2.0 * scales.velocity / bend_),
                           std::sqrt(2.0 * way / slope), std::cbrt(6.0 * way / bend_)});
  if (a.rate != 0.0) width = std::min(width, way / std::abs(a.rate));
  return std::max(width, 1e-14);
}

PeriodMesh graded_mesh(const PrescribedHarmonics& motion, const Scales& scales, const MeshSettings& settings) {
  PeriodMesh mesh;
  const int end = motion.stops() + 1, middle = motion.half_wave() ? 1 + motion.stops() / 2 : end;
  const auto cap = [&](int anchor) { return settings.cap * motion.layer(anchor, scales); };
  if (motion.origin() > 0.0) append_graded(mesh.virgin, 0, 1, motion.origin(), infinite, cap(1), settings);
  // Far above the velocity at which the element changes, a phase of least speed is like any other.
  const double slow = std::isfinite(scales.velocity) ? 40.0 * scales.velocity : 0.0;
  int last = 1;
  for (int i = 2; i <= end; ++i) {
    if (i != middle && i != end && std::abs(motion.rate(i)) > slow) continue;
    auto& stretch = i <= middle ? mesh.first : mesh.second;
    append_graded(stretch, last, i, motion.phase(i) - motion.phase(last), cap(last), cap(i), settings);
    last = i;
  }
  return mesh;
}

}  // namespace limcycle
