#include "limcycle/models/linear/integral_action.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/linear/transfer.hpp"

namespace limcycle {
namespace {

using Roots = std::vector<std::complex<double>>;

Roots by_modulus(const Eigen::VectorXcd& values) {
  Roots roots(values.begin(), values.end());
  std::ranges::sort(roots, {}, [](const auto& root) { return std::abs(root); });
  return roots;
}

/// Coefficients of gain prod(s - root), highest power first; complex roots come in pairs.
std::vector<double> polynomial(const Roots& roots, double gain) {
  std::vector<std::complex<double>> all{gain};
  for (const auto& root : roots) {
    all.emplace_back(0.0);
    for (std::size_t i = all.size() - 1; i > 0; --i) all[i] -= root * all[i - 1];
  }
  std::vector<double> real;
  real.reserve(all.size());
  for (const auto& one : all) real.push_back(one.real());
  return real;
}

std::complex<double> product(std::complex<double> s, const Roots& roots) {
  std::complex<double> all = 1.0;
  for (const auto& root : roots) all *= s - root;
  return all;
}

}  // namespace

Rational rational_of(const StateSpace& of) {
  const StateSpace H = minimal(of).H;
  const auto zeros_of = zeros(H);
  if (!zeros_of) return {{0.0}, {1.0}};
  const Roots zero = by_modulus(*zeros_of);
  Roots pole = by_modulus(H.states() > 0 ? eigenvalues(balanced(H.A)) : Eigen::VectorXcd());
  const auto at_origin = static_cast<std::size_t>(without_origin_pole(H).order);
  std::fill_n(pole.begin(), std::min(at_origin, pole.size()), 0.0);
  double far = 1.0;  // beyond all poles and zeros
  if (!pole.empty() && std::abs(pole.back()) > 0.0) far = std::abs(pole.back());
  if (!zero.empty()) far = std::max(far, std::abs(zero.back()));
  const std::complex<double> s = 2.0 * far;
  const double gain = (H.at(s)(0, 0) * product(s, pole) / product(s, zero)).real();
  return {polynomial(zero, gain), polynomial(pole, 1.0)};
}

std::optional<Rational> without_integral_action(Rational of) {
  auto& [numerator, denominator] = of;
  std::size_t order = 0;
  while (order + 1 < denominator.size() && denominator[denominator.size() - 1 - order] == 0.0) ++order;
  if (order == 0) return std::nullopt;
  denominator.resize(denominator.size() - order);
  numerator.resize(numerator.size() > order ? numerator.size() - order : 0);
  if (numerator.empty()) numerator = {0.0};
  return of;
}

}  // namespace limcycle
