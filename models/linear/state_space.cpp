#include "limcycle/models/linear/state_space.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using Polynomial = std::vector<double>;

std::span<const double> without_leading_zeros(std::span<const double> p) {
  while (!p.empty() && p.front() == 0.0) p = p.subspan(1);
  return p;
}

/// Time unit that makes the coefficients of a monic polynomial comparable: |a_0|^(1/n), or the largest |a_i|^(1/(n-i)).
double time_scale(const Polynomial& monic) {
  double scale = 0.0;
  for (std::size_t i = 1; i < monic.size(); ++i)
    scale = std::max(scale, std::pow(std::abs(monic[i]), 1.0 / static_cast<double>(i)));
  return scale > 0.0 ? scale : 1.0;
}

StateSpace gain_only(double gain) {
  return {Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 1), Eigen::MatrixXd(1, 0), Eigen::MatrixXd::Constant(1, 1, gain)};
}

/// u -> first -> second -> y.
StateSpace in_series(const StateSpace& first, const StateSpace& second) {
  const auto n1 = first.states(), n2 = second.states();
  StateSpace g{Eigen::MatrixXd::Zero(n1 + n2, n1 + n2), Eigen::MatrixXd(n1 + n2, 1), Eigen::MatrixXd(1, n1 + n2),
               second.D * first.D};
  g.A.topLeftCorner(n1, n1) = first.A;
  g.A.bottomLeftCorner(n2, n1) = second.B * first.C;
  g.A.bottomRightCorner(n2, n2) = second.A;
  g.B << first.B, second.B * first.D;
  g.C << second.D * first.C, second.C;
  return g;
}

/// Splits roots into real ones and conjugate pairs (one of each pair is kept); throws if a partner is missing.
std::vector<Polynomial> factors(std::vector<Complex> roots, const char* what) {
  std::vector<Polynomial> result;
  while (!roots.empty()) {
    const Complex root = roots.back();
    roots.pop_back();
    if (root.imag() == 0.0) {
      result.push_back({1.0, -root.real()});
      continue;
    }
    const auto partner = std::ranges::find(roots, std::conj(root));
    if (partner == roots.end()) throw std::invalid_argument(std::string(what) + " must come in conjugate pairs");
    roots.erase(partner);
    result.push_back({1.0, -2.0 * root.real(), std::norm(root)});
  }
  std::ranges::stable_sort(result, {}, [](const Polynomial& p) { return p.size(); });
  return result;
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial c(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  return c;
}

}  // namespace

bool does_not_reach(const Eigen::RowVectorXd& C, const Eigen::VectorXd& B) {
  return std::abs((C * B).value()) <= 1e-12 * (C.cwiseAbs() * B.cwiseAbs()).value();
}

Eigen::MatrixXcd StateSpace::at(std::complex<double> s) const {
  if (states() == 0) return D.cast<Complex>();
  const Eigen::MatrixXcd resolvent = s * Eigen::MatrixXcd::Identity(states(), states()) - A.cast<Complex>();
  return C.cast<Complex>() * solve_columns(resolvent, B.cast<Complex>()) + D.cast<Complex>();
}

StateSpace realise(std::span<const double> numerator, std::span<const double> denominator) {
  const auto den = without_leading_zeros(denominator);
  const auto num = without_leading_zeros(numerator);
  if (den.empty()) throw std::invalid_argument("the denominator is zero");
  if (num.size() > den.size()) throw std::invalid_argument("the numerator has a higher degree than the denominator");
  const std::size_t n = den.size() - 1;
  Polynomial a(den.begin(), den.end()), b(den.size() - num.size(), 0.0);
  b.insert(b.end(), num.begin(), num.end());
  for (auto& value : b) value /= den.front();
  for (auto& value : a) value /= den.front();
  if (n == 0) return gain_only(b[0]);

  // Controllable form in the scaled time p = s / scale, so that the states of a fast or slow plant are of similar size.
  const double scale = time_scale(a);
  const auto order = static_cast<Eigen::Index>(n);
  StateSpace g{Eigen::MatrixXd::Zero(order, order), Eigen::MatrixXd::Zero(order, 1), Eigen::MatrixXd(1, order),
               Eigen::MatrixXd::Constant(1, 1, b[0])};
  for (Eigen::Index i = 0; i + 1 < order; ++i) g.A(i, i + 1) = scale;
  double power = 1.0;
  for (std::size_t i = 1; i <= n; ++i) {
    power *= scale;  // scale^i
    const auto column = order - static_cast<Eigen::Index>(i);
    g.A(order - 1, column) = -a[i] / power * scale;
    g.C(0, column) = (b[i] - a[i] * b[0]) / power;
  }
  g.B(order - 1, 0) = scale;
  return g;
}

StateSpace realise_zpk(std::vector<std::complex<double>> zeros, std::vector<std::complex<double>> poles, double gain) {
  if (zeros.size() > poles.size()) throw std::invalid_argument("there are more zeros than poles");
  auto numerators = factors(std::move(zeros), "zeros");
  auto denominators = factors(std::move(poles), "poles");
  // A pair of zeros needs a second-order section: join two real poles if no pair is left for it.
  const auto pairs = [](const auto& list) { return std::ranges::count(list, 3U, &Polynomial::size); };
  while (pairs(numerators) > pairs(denominators)) {
    const Polynomial joined = product(denominators[0], denominators[1]);
    denominators.erase(denominators.begin(), denominators.begin() + 2);
    denominators.push_back(joined);
  }
  StateSpace g = gain_only(gain);
  while (!denominators.empty()) {
    Polynomial den = denominators.back(), num{1.0};
    denominators.pop_back();
    const bool fits = !numerators.empty() && numerators.back().size() <= den.size();
    if (fits) {
      num = numerators.back();
      numerators.pop_back();
      if (den.size() == 3 && num.size() == 2 && !numerators.empty() && numerators.back().size() == 2) {
        num = product(num, numerators.back());
        numerators.pop_back();
      }
    }
    g = in_series(g, realise(num, den));
  }
  return g;
}

}  // namespace limcycle
