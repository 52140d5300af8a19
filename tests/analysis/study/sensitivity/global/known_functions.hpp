#pragma once
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

/// Functions on the unit cube with a known sensitivity in closed form.
namespace limcycle::test {

using Answer = std::optional<double>;

struct KnownFunction {
  std::size_t parameters;
  std::function<Answer(const std::vector<double>&)> value;  ///< of shares in (0, 1)
  std::vector<double> first, total;
};

/// sin x1 + a sin^2 x2 + b x3^4 sin x1 with x in -pi .. pi (T. Ishigami, T. Homma, 1990); a = 7, b = 0.1.
inline KnownFunction ishigami() {
  using std::numbers::pi;
  const double a = 7.0, b = 0.1, pi4 = std::pow(pi, 4), pi8 = pi4 * pi4;
  const double v1 = 0.5 * std::pow(1.0 + b * pi4 / 5.0, 2), v2 = a * a / 8.0, v13 = b * b * pi8 * (1.0 / 18 - 1.0 / 50);
  const double v = v1 + v2 + v13;
  const auto value = [=](const std::vector<double>& p) -> Answer {
    const double x = pi * (2 * p[0] - 1), y = pi * (2 * p[1] - 1), z = pi * (2 * p[2] - 1);
    return std::sin(x) + a * std::sin(y) * std::sin(y) + b * z * z * z * z * std::sin(x);
  };
  return {3, value, {v1 / v, v2 / v, 0.0}, {(v1 + v13) / v, v2 / v, v13 / v}};
}

/// Product of (|4 p_i - 2| + a_i) / (1 + a_i) (Sobol's g).
inline KnownFunction sobol_g(const std::vector<double>& a) {
  KnownFunction g{a.size(), {}, {}, {}};
  double product = 1.0;
  for (const double one : a) product *= 1.0 + 1.0 / (3.0 * (1.0 + one) * (1.0 + one));
  for (const double one : a) {
    const double v = 1.0 / (3.0 * (1.0 + one) * (1.0 + one));
    g.first.push_back(v / (product - 1.0));
    g.total.push_back(v * product / (1.0 + v) / (product - 1.0));
  }
  g.value = [a](const std::vector<double>& p) -> Answer {
    double y = 1.0;
    for (std::size_t i = 0; i < a.size(); ++i) y *= (std::abs(4 * p[i] - 2) + a[i]) / (1 + a[i]);
    return y;
  };
  return g;
}

/// The answers of a function in all rows of a design.
template <class Design, class F>
std::vector<Answer> answers_in(const Design& design, const F& f) {
  std::vector<Answer> answers;
  for (std::size_t k = 0; k < design.rows(); ++k) answers.push_back(f(design.row(k)));
  return answers;
}

}  // namespace limcycle::test
