#include "limcycle/analysis/energy/loop/positive_real.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double on_axis = 1e-10;              ///< |Re s| below this share of the matrix: on the imaginary axis
constexpr double value_accuracy = 1e-10;       ///< of the least value, relative to the size of Re H
constexpr double evaluation_rounding = 1e-12;  ///< of an evaluated H, relative

/// H(s) + H(-s) - 2 level.
StateSpace spectral(const StateSpace& H, double level, double size) {
  const Index n = H.states();
  StateSpace sum{MatrixXd::Zero(2 * n, 2 * n), MatrixXd(2 * n, 1), MatrixXd(1, 2 * n), 2.0 * H.D};
  sum.A.topLeftCorner(n, n) = H.A;
  sum.A.bottomRightCorner(n, n) = -H.A.transpose();
  sum.B << H.B, -H.C.transpose();
  sum.C << H.C, H.B.transpose();
  const double left = H.D(0, 0) - level;
  sum.D(0, 0) = std::abs(left) <= 1e-13 * size ? 0.0 : 2.0 * left;
  return sum;
}

}  // namespace

RealPart::RealPart(const StateSpace& H, double A_size, double D_size)
    : reduced_(minimal(H, A_size)),
      origin_(without_origin_pole(reduced_.H, A_size)),
      size_(D_size),
      A_size_(std::max(A_size, reduced_.H.A.norm())) {
  rest_ = origin_.order == 1 ? origin_.rest : reduced_.H;
  rightmost_ = origin_.order > 0 ? 0.0 : -infinity;
  residues_positive_ = origin_.order == 0 || (origin_.order == 1 && origin_.residue > 0.0);
  residues_real_ = origin_.order <= 1;
  take_out_axis_poles();
  scale_of_frequencies();
  find_least();
  if (unresolved_) least_.error = infinity;
}

/// Poles on the axis with a real residue are lossless: they are removed, and B loses the part that excites them.
void RealPart::take_out_axis_poles() {
  if (rest_.states() == 0) return;
  const auto [poles, V] = eigen_pairs(rest_.A);
  const Eigen::VectorXcd excited = solve_columns(V, rest_.B.cast<Complex>());
  for (Index i = 0; i < rest_.states(); ++i) {
    const Complex pole = poles(i);
    const bool at_zero = origin_.order > 1 && std::abs(pole) < 1e-7 * A_size_;
    if (!at_zero) moduli_.push_back(std::abs(pole));
    const bool axis =
        !at_zero && std::abs(pole.real()) <= on_axis * A_size_ && std::abs(pole.imag()) > on_axis * A_size_;
    if (!at_zero) rightmost_ = std::max(rightmost_, axis ? 0.0 : pole.real());
    if (!axis || pole.imag() < 0.0) continue;
    const Complex residue = (rest_.C.cast<Complex>() * V.col(i)).value() * excited(i);
    axis_poles_.push_back(pole.imag());
    residues_real_ = residues_real_ && std::abs(residue.imag()) <= 1e-8 * std::abs(residue);
    residues_positive_ = residues_positive_ && residue.real() > 0.0;
    rest_.B -= 2.0 * (V.col(i) * excited(i)).real();
  }
  if (rest_.B.norm() <= evaluation_rounding * reduced_.H.B.norm())  // nothing else remains
    rest_ = {MatrixXd(0, 0), MatrixXd(0, 1), MatrixXd(1, 0), rest_.D};
}

void RealPart::scale_of_frequencies() {
  std::ranges::sort(moduli_);
  if (moduli_.empty()) return;
  std::erase_if(moduli_, [fastest = moduli_.back()](double w) { return w <= 1e-7 * fastest; });
  slow_ = moduli_.front();
  fast_ = moduli_.back();
}

double RealPart::at(double w) const { return rest_.at({0.0, w})(0, 0).real(); }

/// Rounding error of at(w).
double RealPart::noise(double w) const { return evaluation_rounding * (std::abs(rest_.at({0.0, w})(0, 0)) + size_); }

bool RealPart::near_axis_pole(double w) const {
  return std::ranges::any_of(axis_poles_, [w](double pole) { return std::abs(w - pole) < 1e-6 * pole; });
}

/// Frequencies between which Re H - level keeps its sign, and some on each side; nothing if Re H is the level
/// everywhere.
std::optional<std::vector<double>> RealPart::samples(double level) const {
  const auto found = zeros(spectral(rest_, level, size_));
  if (!found) return std::nullopt;
  std::vector<double> edges(moduli_);
  for (const Complex s : *found)
    for (const double w : {std::abs(s.imag()), std::abs(s)})
      if (std::isfinite(w) && w > 1e-7 * slow_) edges.push_back(w);
  std::ranges::sort(edges);
  std::vector<double> points;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    points.push_back(edges[i]);
    if (i + 1 < edges.size()) points.push_back(0.5 * (edges[i] + edges[i + 1]));
    if (i + 1 < edges.size()) points.push_back(std::sqrt(edges[i] * edges[i + 1]));
  }
  if (edges.empty()) edges = {slow_};
  for (const double share : {1e-3, 1e-1, 0.5}) points.push_back(share * edges.front());
  for (const double share : {2.0, 10.0, 1e3}) points.push_back(share * edges.back());
  for (const double pole : axis_poles_) points.insert(points.end(), {pole * (1.0 - 1e-5), pole * (1.0 + 1e-5)});
  std::erase_if(points, [this](double w) { return near_axis_pole(w); });
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// Lowest point of Re H between two frequencies, if there is one between.
double RealPart::golden(double low, double high) const {
  constexpr double ratio = 0.6180339887498949;
  double a = std::log(low), b = std::log(high);
  for (int i = 0; i < 60; ++i) {
    const double c = b - ratio * (b - a), d = a + ratio * (b - a);
    (at(std::exp(c)) < at(std::exp(d)) ? b : a) = at(std::exp(c)) < at(std::exp(d)) ? d : c;
  }
  return std::exp(0.5 * (a + b));
}

/// Takes the lowest of these points, and lower values near it.
void RealPart::lower(std::vector<double> points) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (at(points[i]) < at(points[best])) best = i;
  if (best > 0 && best + 1 < points.size()) points[best] = golden(points[best - 1], points[best + 1]);
  const double value = at(points[best]);
  if (!(value < least_.value)) return;
  least_.value = value;
  least_.frequency = points[best];
}

double RealPart::limit_at_zero() const {
  if (rest_.states() == 0) return rest_.D(0, 0);
  return rest_.D(0, 0) - (rest_.C * solve_columns_fully_pivoted(rest_.A, rest_.B)).value();
}

/// Limit of Re H at the origin for a multiple pole there: -infinity or +infinity, if any.
std::optional<double> RealPart::unbounded_at_zero() const {
  if (origin_.order < 2) return std::nullopt;
  const double w = 1e-3 * slow_, here = at(w), nearer = at(0.1 * w);
  if (std::abs(nearer) < 10.0 * std::abs(here) || here * nearer < 0.0) return std::nullopt;
  return nearer < 0.0 ? -infinity : infinity;
}

void RealPart::find_least() {
  for (const double w : moduli_) size_ = std::max(size_, std::abs(at(w * (1.0 + 1e-4))));
  size_ = std::max(size_, std::abs(rest_.D(0, 0)));
  const auto low_end = unbounded_at_zero();
  if (!residues_real_ && (origin_.order < 2 || low_end != infinity)) {
    least_ = {-infinity, 0.0, 0.0};
    if (origin_.order < 2) least_.frequency = axis_poles_.front();
    if (origin_.order >= 2 && !low_end) least_.value = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  least_ = {rest_.D(0, 0), infinity, value_accuracy * size_};
  if (rest_.states() == 0) {
    least_.error = 1e-15 * size_;
    return;
  }
  if (!low_end && limit_at_zero() < least_.value) least_ = {limit_at_zero(), 0.0, value_accuracy * size_};
  descend();
}

/// Descends from the least value found to lower levels, as long as they are reached.
void RealPart::descend() {
  lower(samples(least_.value).value_or(moduli_));
  for (int i = 0; i < 30; ++i) {
    const double before = least_.value;
    const auto points = samples(before - value_accuracy * size_);
    if (!points) return;
    lower(*points);
    if (!(least_.value < before - value_accuracy * size_)) return;
  }
  least_.error = infinity;  // it keeps falling: the value is not reliable
}

Decision RealPart::above(double level) const {
  if (std::isnan(least_.value) || std::isnan(level)) return Decision::undecided;
  if (least_.value > level + least_.error) return Decision::yes;
  if (least_.value < level - least_.error) return Decision::no;
  const auto points = samples(level);
  if (!points) return Decision::no;  // equal everywhere
  bool sure = true;
  for (const double w : *points) {
    const double over = at(w) - level, doubt = noise(w) + evaluation_rounding * std::abs(level);
    if (over < -doubt) return Decision::no;
    sure = sure && over > doubt;
  }
  return sure ? Decision::yes : Decision::undecided;
}

PositiveReal positive_real(const RealPart& H) {
  const auto say = [](Decision decision, std::string why, bool strictly = false) {
    return PositiveReal{{decision, std::move(why)}, strictly};
  };
  const RealPart::Least& least = H.least();
  if (H.rightmost_pole() > 0.0)
    return say(Decision::no, "it has a pole with the real part " + short_number(H.rightmost_pole()) + " 1/s");
  if (std::isnan(least.value) || !std::isfinite(least.error))
    return say(Decision::undecided, "the least real part could not be computed");
  if (!H.residues_real() || H.origin().order > 1)
    return say(Decision::no, "its poles on the imaginary axis are not simple with real residues");
  if (!H.residues_positive()) return say(Decision::no, "a pole on the imaginary axis has a negative residue");
  const std::string value = "its real part is " + short_number(least.value) + (H.constant() ? " " : " at least, ");
  const std::string place = H.constant()                  ? "at every frequency"
                            : least.frequency == 0.0      ? "as the frequency goes to 0"
                            : std::isinf(least.frequency) ? "as the frequency goes to infinity"
                                                          : "at " + short_number(least.frequency) + " rad/s";
  const Decision strict = H.above(0.0);
  if (strict == Decision::yes) return say(Decision::yes, value + place, true);
  if (least.value < -least.error) return say(Decision::no, value + place);
  if (H.constant() && least.value == 0.0) return say(Decision::yes, value + place);
  return say(Decision::undecided, value + place + ": zero to rounding");
}

}  // namespace limcycle
