#include "limcycle/reports/csv.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <sstream>

#include "limcycle/tests/lines.hpp"
#include "limcycle/tests/reports/sample_report.hpp"

using namespace limcycle;
using namespace limcycle::test;

TEST_CASE("df: names of the columns are the keys of the document") {
  DescribingFunction result;
  result.gain = {1.5, 0.1};
  result.mean = 0.125;
  result.harmonics = {{3.0, 0.2}, {0.0, -1.0}};
  result.dissipation = 3.25;
  result.error = 1e-9;
  result.method = "fft";
  DescribingFunction unanswered;
  unanswered.status = Status::not_finite;
  unanswered.method = "quadrature";
  CHECK(df_csv({{2.0, 3.0, 0.5}, {1.0, 2.0, 0.0}}, {result, unanswered}) ==
        "amplitude,frequency,bias,gain_re,gain_im,mean,harmonic_1_sine,harmonic_1_cosine,harmonic_2_sine,"
        "harmonic_2_cosine,dissipation,error,method,status\n"
        "2,3,0.5,1.5,0.1,0.125,3,0.2,0,-1,3.25,1e-09,fft,converged\n"
        "1,2,0,,,,,,,,,,quadrature,not_finite\n");
  CHECK_THROWS_AS(df_csv({}, {result}), std::invalid_argument);
}

TEST_CASE("predict: a row for each cycle, prediction, missed cycle and start") {
  auto report = sample::relay();
  report.missed = {{"harmonic-balance", 0}};
  report.outcomes[0].why = "a, \"b\"";
  const auto lines = lines_of(predict_csv(report));
  REQUIRE(lines.size() == 7);
  CHECK(lines[0] ==
        "kind,index,method,amplitude,first_harmonic,period,frequency,offset,stable,multiplier_re,multiplier_im,"
        "sticking_fraction,error,residual,verdict,cycle,start,outcome,why");
  CHECK(lines[1].starts_with("cycle,0,exact,0.65831343,0.65,6.283185307179586,"));
  CHECK(lines[1].find(",1e-14,true,0.0095,-0.001,0,1e-10,3e-12,,,,,") != std::string::npos);
  CHECK(lines[2] == "prediction,0,describing-function,0.637,,,1.01,,true,,,,,1e-12,confirmed,0,,,within 5 %");
  CHECK(lines[3] == "prediction,1,describing-function,0.1,,,7,,,,,,,2e-12,false,,,,it comes to rest");
  CHECK(lines[4] == "missed,0,harmonic-balance,,,,,,,,,,,,,0,,,");
  CHECK(lines[5] == "outcome,0,,,,,,,,,,,,,,0,y(0) = 1,cycle,\"a, \"\"b\"\"\"");
  const auto commas = std::count(lines[0].begin(), lines[0].end(), ',');
  for (const auto i : {1u, 2u, 3u, 4u, 6u}) CHECK(std::count(lines[i].begin(), lines[i].end(), ',') == commas);
}

TEST_CASE("simulate: its columns, what is not a number is empty") {
  Simulation run;
  run.columns = {"t", "loop.friction.input"};
  run.rows = {{0.1, 1e-7}, {0.2, std::numeric_limits<double>::quiet_NaN()}};
  CHECK(simulate_csv(run) == "t,loop.friction.input\n0.1,1e-07\n0.2,\n");
}
