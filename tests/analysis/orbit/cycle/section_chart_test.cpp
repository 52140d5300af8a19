#include "limcycle/analysis/orbit/cycle/section_chart.hpp"

#include <catch2/catch.hpp>

using namespace limcycle;

namespace {

/// Two linear states and one of an element, of very different sizes; the plane cuts the linear ones.
const Section plane{Eigen::RowVector2d(2.0, -3.0), 0.7, 1};
const State largest{1e-3, 40.0, 0.0}, typical{1.0, 1.0, 1e4}, origin{1.0, 0.5, -2.0};

SectionChart chart() { return {plane, largest, typical}; }

}  // namespace

TEST_CASE("a chart stays on its plane, and its coordinates are those it was lifted from") {
  const SectionChart on = chart();
  CHECK(on.scale(1) == 40.0);
  CHECK(on.scale(2) == 0.01);  // a state that vanishes on the orbit counts as 1e-6 of its typical size
  const Eigen::Vector2d u(0.3, -0.8);
  const State x = on.lift(origin, u);
  CHECK(plane.value(x) == Approx(plane.value(origin)).margin(1e-13));
  CHECK((on.coordinates(x, origin) - u).norm() < 1e-12);
  CHECK((on.basis.transpose() * on.basis - Eigen::Matrix2d::Identity()).norm() < 1e-14);
}

TEST_CASE("a derivative in coordinates is that of the map between coordinates") {
  const SectionChart on = chart();
  Eigen::Matrix3d D;
  D << 0.2, -1e-5, 3e-2, 4e2, 0.7, -5.0, 1e-1, 2e-4, -0.3;
  const Eigen::Vector2d u(0.3, -0.8);
  const State x = on.lift({0.0, 0.0, 0.0}, u);
  const Eigen::Vector3d image = D * Eigen::Vector3d(x[0], x[1], x[2]);
  const Eigen::VectorXd expected = on.coordinates({image(0), image(1), image(2)}, {0.0, 0.0, 0.0});
  CHECK((on.restricted(D) * u - expected).norm() < 1e-12 * expected.norm());
}
