#include "limcycle/models/measured/vector_fit.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/measured/fit_choice.hpp"
#include "limcycle/tests/measured.hpp"

using namespace limcycle;
using limcycle::test::ResponseOf;
using limcycle::test::sampled_response;
using Complex = std::complex<double>;

namespace {

/// Largest relative distance from the function itself, between the points too.
double true_error(const StateSpace& model, const ResponseOf& G, double from, double to) {
  double largest = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double w = from * std::pow(to / from, i / 1000.0);
    largest = std::max(largest, std::abs(response_of(model, w) / G({0.0, w}) - 1.0));
  }
  return largest;
}

struct Known {
  std::string name;
  ResponseOf G;
  FitShape shape;
};

const std::vector<Known>& known_functions() {
  static const std::vector<Known> list{
      {"free mass", [](Complex s) { return 1.0 / (3.0 * s * s); }, {2, 2, 2}},
      {"mass with damping", [](Complex s) { return 1.0 / (s * (5.0 * s + 2.0)); }, {2, 1, 2}},
      {"lag", [](Complex s) { return -4.0 / (0.3 * s + 1.0); }, {1, 0, 1}},
      {"three equal lags", [](Complex s) { return 1.0 / ((s + 1.0) * (s + 1.0) * (s + 1.0)); }, {3, 0, 2}},
      {"two masses", limcycle::test::two_masses(1.0), {4, 2, 2}},
      {"light damping",
       [](Complex s) { return 1.0 / (s * s + 0.02 * s + 100.0) + 1.0 / (s * s + 0.06 * s + 900.0); },
       {4, 0, 2}},
      {"right zero", [](Complex s) { return (2.0 - s) / ((s + 1.0) * (s * s + s + 9.0)); }, {3, 0, 2}}};
  return list;
}

}  // namespace

TEST_CASE("pole basis: the functions are those of its state space, and orthonormal") {
  const Poles poles{{{-0.5, 0.0}, {-0.5, 0.0}, {-0.1, 3.0}, {-2.0, 7.0}}, 0};
  const PoleBasis basis(poles);
  REQUIRE(basis.size() == 6);
  Eigen::MatrixXcd products = Eigen::MatrixXcd::Zero(6, 6);
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {  // w = tan(a): the whole axis
    const double a = std::numbers::pi * ((i + 0.5) / steps - 0.5), w = std::tan(a);
    const Eigen::VectorXcd x = basis.at({0.0, w});
    products += x * x.adjoint() * ((1.0 + w * w) / (2.0 * steps));
  }
  CHECK((products - Eigen::MatrixXcd::Identity(6, 6)).norm() < 1e-6);
  const Poles with_zero{poles.stable, 2};
  const PoleBasis more(with_zero);
  const Complex s(0.3, 1.7);
  const StateSpace space{more.A, more.B, Eigen::MatrixXd::Identity(8, 8), Eigen::MatrixXd::Zero(8, 1)};
  CHECK((more.at(s) - space.at(s).col(0)).norm() < 1e-13 * more.at(s).norm());
  CHECK(std::abs(more.at(s)(1) - 1.0 / (s * s)) < 1e-14);
}

TEST_CASE("vector fit: order, poles at zero and relative degree of known functions are found, in any unit of time") {
  for (const auto& [name, G, shape] : known_functions()) {
    for (const double unit : {1.0, 2e-4}) {
      INFO(name << ", unit " << unit);
      const ResponseOf scaled = [&, of = G](Complex s) { return of(unit * s); };
      const double from = 0.05 / unit, to = 200.0 / unit;
      const auto fit = chosen_fit(sampled_response(scaled, from, to, 200), {});
      REQUIRE(fit);
      CHECK(fit->shape.order == shape.order);
      CHECK(fit->shape.poles_at_zero == shape.poles_at_zero);
      CHECK(fit->shape.relative_degree == shape.relative_degree);
      CHECK(fit->error.largest < 1e-8);
      CHECK(true_error(fit->model, scaled, from, to) < 1e-8);
      CHECK(fit->error.rms <= fit->error.largest);
      const double direct = (fit->model.C * fit->model.B).value();
      if (shape.relative_degree == 2) CHECK(does_not_reach(fit->model.C.row(0), fit->model.B.col(0)));
      if (shape.relative_degree == 1) CHECK(std::abs(direct) > 0.0);
    }
  }
}

TEST_CASE("vector fit: with noise the order is found, the error is that of the data, and the fit is nearer than they") {
  for (const auto& [name, G, shape] : known_functions()) {
    if (name == "light damping") continue;  // between the points of a resonance there is nothing to average
    for (const double deviation : {1e-4, 1e-2}) {
      INFO(name << " " << deviation);
      const auto fit = chosen_fit(sampled_response(G, 0.05, 200.0, 200, deviation), {});
      REQUIRE(fit);
      CHECK(fit->shape.order == shape.order);
      CHECK(fit->shape.poles_at_zero == shape.poles_at_zero);
      CHECK(fit->error.rms == Approx(std::sqrt(2.0) * deviation).epsilon(0.1));
      REQUIRE(fit->error.deviations);
      CHECK(*fit->error.deviations == Approx(1.0).epsilon(0.1));
      CHECK(true_error(fit->model, G, 0.05, 200.0) < fit->error.largest);
    }
  }
}

TEST_CASE("vector fit: of a function that is not rational the error falls geometrically with the order") {
  const ResponseOf diffusion = [](Complex s) { return 1.0 / (s * (1.0 + std::sqrt(s))); };
  const FrequencyData data = sampled_response(diffusion, 0.01, 100.0, 300);
  double last = 0.0;
  for (const int order : {3, 5, 7, 9}) {
    const VectorFit fit = vector_fit(data, {order, 1, 1});
    REQUIRE(fit.model.states() == order);
    CHECK(true_error(fit.model, diffusion, 0.01, 100.0) < 1.5 * fit.error.largest);
    if (order > 3) CHECK(fit.error.rms < 0.4 * last);
    last = fit.error.rms;
  }
  CHECK(last < 1e-3);
}

TEST_CASE("vector fit: poles stay in the left half plane, whatever the data") {
  const ResponseOf unstable = [](Complex s) { return 1.0 / ((s - 1.0) * (s + 3.0)); };
  const auto fit = vector_fit(sampled_response(unstable, 0.1, 50.0, 100), {2, 0, 2});
  REQUIRE(fit.model.states() == 2);
  for (const auto& pole : eigenvalues(fit.model.A)) CHECK(pole.real() < 0.0);
  CHECK(fit.error.rms > 0.3);
}

TEST_CASE("vector fit: what is asked for is done, and too few points are none") {
  const FrequencyData data = sampled_response(limcycle::test::two_masses(1.0), 1.0, 200.0, 50);
  const auto fit = chosen_fit(data, {.order = 6, .poles_at_zero = 1, .relative_degree = 1});
  REQUIRE(fit);
  CHECK(fit->shape.order == 6);
  CHECK(fit->shape.poles_at_zero == 1);
  CHECK(fit->shape.relative_degree == 1);
  CHECK(fit->error.rms < 1e-3);
  CHECK_FALSE(chosen_fit(sampled_response(limcycle::test::two_masses(1.0), 1.0, 200.0, 3), {}));
  CHECK_FALSE(chosen_fit(sampled_response(limcycle::test::two_masses(1.0), 1.0, 200.0, 12),
                         {.order = 8, .poles_at_zero = {}, .relative_degree = {}}));
}

TEST_CASE("gaps: equal steps have none, in frequency or in its logarithm") {
  std::vector<double> linear, logarithmic;
  for (int i = 1; i <= 50; ++i) {
    linear.push_back(0.5 * i);
    logarithmic.push_back(std::pow(1.2, i));
  }
  CHECK(gaps_in(linear).empty());
  CHECK(gaps_in(logarithmic).empty());
  CHECK(gaps_in({1.0}).empty());
  linear.erase(linear.begin() + 20, linear.begin() + 32);
  CHECK(gaps_in(linear) == std::vector<std::size_t>{19});
  logarithmic.erase(logarithmic.begin() + 10, logarithmic.begin() + 20);
  CHECK(gaps_in(logarithmic) == std::vector<std::size_t>{9});
}
