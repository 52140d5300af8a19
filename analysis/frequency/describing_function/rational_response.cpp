#include "limcycle/analysis/frequency/describing_function/rational_response.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;

/// Value of a polynomial at the middle of an interval, and bound of its deviation from that value inside.
struct Ball {
  Complex centre;
  double radius = 0.0;
};

/// p(j x) for x in [low, high]: Taylor coefficients about the middle by repeated synthetic division.
Ball over(const std::vector<double>& p, Interval x) {
  const double middle = 0.5 * (x.low + x.high), half = 0.5 * (x.high - x.low);
  const Complex at(0.0, middle);
  std::vector<Complex> c(p.begin(), p.end());
  Ball ball;
  double power = 1.0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    for (std::size_t k = c.size() - 1; k-- > i;) c[k] += at * c[k + 1];
    if (i == 0)
      ball.centre = c[0];
    else
      ball.radius += std::abs(c[i]) * power;
    if (half == 0.0) break;
    power *= half;
  }
  return ball;
}

std::vector<double> combined(const std::vector<double>& d, double c, const std::vector<double>& n) {
  std::vector<double> q = d;
  for (std::size_t i = 0; i < n.size(); ++i) q[i] += c * n[i];
  return q;
}

/// A real polynomial in x^2 (index: power of x^2), with the sizes of the terms that are summed in its coefficients.
struct Even {
  std::vector<double> sum, size;

  /// Adds factor |p(jx)|^2.
  void add(const std::vector<double>& p, double factor) {
    // p(jx) = sum of j^i p_i x^i: terms i and k meet in the real part of p conj(p) if i + k is even, with sign j^(i-k).
    for (std::size_t i = 0; i < p.size(); ++i)
      for (std::size_t k = i % 2; k < p.size(); k += 2) {
        const double term = factor * p[i] * p[k];
        sum[(i + k) / 2] += (i > k ? i - k : k - i) % 4 == 0 ? term : -term;
        size[(i + k) / 2] += std::abs(term);
      }
  }
  /// Coefficients; those that are only roundings of their terms are 0.
  std::vector<double> coefficients() const {
    std::vector<double> c = sum;
    for (std::size_t i = 0; i < c.size(); ++i)
      if (std::abs(c[i]) <= 1e-14 * size[i]) c[i] = 0.0;
    return c;
  }
};

/// Lower bound of a real polynomial over [low, high].
double least(const std::vector<double>& p, Interval x) {
  const double middle = 0.5 * (x.low + x.high), half = 0.5 * (x.high - x.low);
  std::vector<double> c = p;
  double value = 0.0, power = 1.0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    for (std::size_t k = c.size() - 1; k-- > i;) c[k] += middle * c[k + 1];
    value += i == 0 ? c[0] : -std::abs(c[i]) * power;
    power *= half;
  }
  return value;
}

/// Geometric middle of the sizes of the poles that are not zero.
double middle_of(const Eigen::VectorXcd& poles) {
  double sum = 0.0;
  int count = 0;
  for (const Complex& pole : poles)
    if (std::abs(pole) > 1e-9 * poles.cwiseAbs().maxCoeff()) {
      sum += std::log(std::abs(pole));
      ++count;
    }
  return count > 0 ? std::exp(sum / count) : 1.0;
}

}  // namespace

std::optional<RationalResponse> RationalResponse::of(const Loop& loop) {
  const Eigen::Index n = loop.states();
  if (loop.elements.size() != 1 || loop.delay > 0.0 || loop.sampled || n == 0) return std::nullopt;
  const Port& port = loop.ports[0];
  if (!port.D.isZero(0.0)) return std::nullopt;
  RationalResponse G;
  G.scale_ = middle_of(eigenvalues(loop.A));
  const Eigen::MatrixXd A = loop.A / G.scale_;
  const Eigen::VectorXd B = loop.B.col(0) / G.scale_;
  G.numerator_.assign(static_cast<std::size_t>(n), 0.0);
  G.denominator_.assign(static_cast<std::size_t>(n) + 1, 0.0);
  G.denominator_.back() = 1.0;
  Eigen::MatrixXd M = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index k = 1; k <= n; ++k) {
    const auto at = static_cast<std::size_t>(n - k);
    const double coefficient = -(port.C * M * B).value();
    const double terms = (port.C.cwiseAbs() * M.cwiseAbs() * B.cwiseAbs()).value();
    G.numerator_[at] = std::abs(coefficient) > 1e-14 * terms ? coefficient : 0.0;  // smaller values are rounding
    const Eigen::MatrixXd AM = A * M;
    G.denominator_[at] = -AM.trace() / static_cast<double>(k);
    M = AM + G.denominator_[at] * Eigen::MatrixXd::Identity(n, n);
  }
  if (std::ranges::all_of(G.numerator_, [](double c) { return c == 0.0; })) return std::nullopt;
  for (const double w : {0.01, 0.1, 0.5, 1.0, 2.0, 10.0, 100.0}) {
    const Complex exact = -1.0 / loop.element_response(w * G.scale_)(0, 0);
    const Complex own = G.inverse(w * G.scale_);
    if (std::isfinite(std::abs(exact)) && !(std::abs(own - exact) <= 1e-9 * std::abs(exact))) return std::nullopt;
  }
  return G;
}

Complex RationalResponse::inverse(double w) const {
  const Interval x{w / scale_, w / scale_};
  return over(denominator_, x).centre / over(numerator_, x).centre;
}

RationalResponse::Disc RationalResponse::inverse(Interval w) const {
  const Interval x{w.low / scale_, w.high / scale_};
  const Ball d = over(denominator_, x), n = over(numerator_, x);
  const Complex q = d.centre / n.centre;
  const double left = std::abs(n.centre) - n.radius;
  // d/n - q = (dd - q dn)/(n + dn), where dd and dn are the deviations from the middle.
  return {q, left > 0.0 ? (d.radius + std::abs(q) * n.radius) / left : infinite};
}

double RationalResponse::distance(double c, Interval w) const {
  const Interval x{w.low / scale_, w.high / scale_};
  const Ball q = over(combined(denominator_, c, numerator_), x), n = over(numerator_, x);
  return std::max(0.0, (std::abs(q.centre) - q.radius) / (std::abs(n.centre) + n.radius));
}

double RationalResponse::growth(double w) const {
  // |d| >= x^n (1 - sum |d_i| x^(i-n)), |n| <= x^n sum |n_i| x^(i-n): the quotient grows with x where it is positive.
  const double x = w / scale_;
  double above = 1.0, below = 0.0, power = 1.0;
  for (std::size_t i = numerator_.size(); i-- > 0;) {
    power /= x;
    above -= std::abs(denominator_[i]) * power;
    below += std::abs(numerator_[i]) * power;
  }
  return above > 0.0 ? above / below : 0.0;
}

bool RationalResponse::farther_than(double gamma, double c, Interval w) const {
  const std::vector<double> none(denominator_.size(), 0.0);
  Even p{none, none};
  p.add(combined(denominator_, c, numerator_), 1.0);
  p.add(numerator_, -gamma * gamma);
  const double low = w.low / scale_, high = w.high / scale_;
  return least(p.coefficients(), {low * low, high * high}) > 0.0;
}

}  // namespace limcycle
