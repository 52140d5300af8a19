#include "limcycle/analysis/study/map/hunting_map.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;

namespace {

PredictOptions asked_of_map() {
  PredictOptions options;
  options.methods = {true, false, false};
  options.accuracy = 1e-6;
  return options;
}

}  // namespace

TEST_CASE("hunting map: sides have exact ends and even steps, linear or logarithmic") {
  const MapAxis linear{"a", 0.1, 0.7, 7, false}, log{"b", 1e-3, 10.0, 5, true}, back{"c", 5.0, -1.0, 3, false};
  CHECK(linear.value(0) == 0.1);
  CHECK(linear.value(6) == 0.7);
  CHECK(linear.value(3) == Approx(0.4));
  CHECK(log.value(4) == 10.0);
  CHECK(log.value(2) == Approx(0.1));
  CHECK(back.value(1) == Approx(2.0));
  CHECK_THROWS_AS(linear.value(7), std::out_of_range);
  CHECK_THROWS_AS(linear.value(-1), std::out_of_range);
}

TEST_CASE("hunting map: the describing function is right of a relay loop and blind to the hunting servo") {
  const MapPoint relay = map_point(test::forward(test::relay(1.0), {1.0}, {1.0, 2.0, 1.0, 0.0}), asked_of_map());
  CHECK(relay.in_words() == "hunting");
  CHECK(relay.stable == 1);
  REQUIRE(relay.methods.size() == 1);
  CHECK(relay.methods[0].worth == Worth::right);
  CHECK(relay.methods[0].frequency == Approx(1.0).margin(0.05));

  const MapPoint servo = map_point(test::servo(test::lugre()), asked_of_map());
  CHECK(servo.has(Outcome::cycle));
  CHECK(servo.methods[0].worth == Worth::missed);
  CHECK(servo.period == Approx(24.4368).epsilon(1e-5));
  CHECK(servo.amplitude == Approx(0.0639025).epsilon(1e-5));
  CHECK(std::isnan(servo.methods[0].amplitude));

  const MapPoint still = map_point(test::servo(test::coulomb(1.0, 1.0)), asked_of_map());
  CHECK(still.in_words() == "rest");
  CHECK(still.stable == 0);
  CHECK(std::isnan(still.period));
  CHECK(still.methods[0].worth == Worth::right);
}

TEST_CASE("hunting map: where a start is undecided a method that predicts nothing is not called right") {
  PredictReport report;
  report.outcomes.resize(2);
  report.outcomes[0].outcome = Outcome::rest;
  report.outcomes[1].outcome = Outcome::undecided;
  CHECK(method_at("describing-function", report).worth == Worth::undecided);
  report.outcomes[1].outcome = Outcome::rest;
  CHECK(method_at("describing-function", report).worth == Worth::right);
}

TEST_CASE("hunting map: a point survives being a row, and no other row is taken for one") {
  MapPoint point;
  point.outcomes = {Outcome::rest, Outcome::cycle};
  point.cycles = 2;
  point.stable = 1;
  point.amplitude = 0.25;
  point.period = 3.0;
  point.methods = {{Worth::wrong, 1.5, 0.5}, {Worth::not_applicable, NAN, NAN}};
  const auto row = to_row(point);
  CHECK(row.size() == map_columns({"one", "two"}).size());
  const MapPoint back = point_of_row(row, 2);
  CHECK(back.outcomes == point.outcomes);
  CHECK(back.in_words() == "rest or hunting");
  CHECK(back.cycles == 2);
  CHECK(back.period == 3.0);
  CHECK(back.methods[0].worth == Worth::wrong);
  CHECK(back.methods[0].frequency == 0.5);
  CHECK(back.methods[1].worth == Worth::not_applicable);
  CHECK_THROWS_AS(point_of_row(row, 1), std::invalid_argument);
  for (const std::size_t i : {0U, 1U, 5U})
    for (const double bad : {-1.0, 0.5, static_cast<double>(NAN), 1e9}) {
      auto changed = row;
      changed[i] = bad;
      CHECK_THROWS_AS(point_of_row(changed, 2), std::invalid_argument);
    }
  CHECK(MapPoint{}.in_words() == "not valid");
}
