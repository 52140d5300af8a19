#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using limcycle::test::message;
using limcycle::test::servo;

namespace {

std::string with_spread(const std::string& body) { return std::string(servo) + "[sensitivity]\n" + body; }
std::string one(const std::string& parameter) { return message(with_spread("parameters = [{" + parameter + "}]\n")); }

}  // namespace

TEST_CASE("section sensitivity: parameters with their distributions, samples, seed") {
  const Case from = read_case(
      with_spread("parameters = [{path = \"loop.friction.Fs\", from = 1.2, to = 1.8},\n"
                  "  {path = \"loop.friction.sigma0\", distribution = \"log-uniform\", factor = 10},\n"
                  "  {path = \"loop.controller.kd\", distribution = \"normal\", deviation = 0.5},\n"
                  "  {path = \"loop.controller.kp\", distribution = \"normal\", mean = 4, deviation = 1, from = 2}]\n"
                  "samples = 200\nseed = 7\n"),
      "a.toml");
  REQUIRE(from.sensitivity);
  const auto& spread = *from.sensitivity;
  CHECK(spread.samples == 200);
  CHECK(spread.seed == 7);
  REQUIRE(spread.parameters.size() == 4);
  CHECK(spread.parameters[0].path == "loop.friction.Fs");
  CHECK(spread.parameters[0].distribution == Distribution::uniform);
  CHECK(spread.parameters[0].value == 1.5);
  CHECK(spread.parameters[0].low == 1.2);
  CHECK(spread.parameters[0].high == 1.8);
  CHECK(spread.parameters[1].low == Approx(1e4));
  CHECK(spread.parameters[1].high == Approx(1e6));
  CHECK(spread.parameters[2].mean == 6.0);
  CHECK(spread.parameters[2].deviation == 0.5);
  CHECK(std::isinf(spread.parameters[2].low));
  CHECK(spread.parameters[3].mean == 4.0);
  CHECK(spread.parameters[3].low == 2.0);
  CHECK(spread.parameters[3].quantile(0.0) == Approx(2.0));
  CHECK_FALSE(read_case(servo, "a.toml").sensitivity);
}

TEST_CASE("section sensitivity: what is refused") {
  CHECK_THAT(message(with_spread("samples = 3\n")), Contains("sensitivity.parameters: is required"));
  CHECK_THAT(message(with_spread("parameters = 1\n")), Contains("must be a list of tables"));
  CHECK_THAT(message(with_spread("parameters = []\n")), Contains("must have 1 to 200 entries"));
  CHECK_THAT(message(with_spread("parameter = []\n")), Contains("did you mean parameters?"));
  CHECK_THAT(one("from = 1, to = 2"), Contains("path: is required"));
  CHECK_THAT(one("path = \"loop.friction.sigm0\", factor = 2"),
             Contains("is not a parameter of this loop") && Contains("did you mean loop.friction.sigma0?"));
  const std::string Fs = "path = \"loop.friction.Fs\", ";
  CHECK_THAT(one(Fs + "from = 1.2"), Contains("parameters[0].to: is required"));
  CHECK_THAT(one(Fs + "to = 1.2"), Contains("parameters[0].from: is required"));
  CHECK_THAT(one(Fs + "from = 1.2, to = 1.2"), Contains("must be greater than from = 1.2 N"));
  CHECK_THAT(one(Fs + "factor = 1"), Contains("must be > 1"));
  CHECK_THAT(one(Fs + "factor = 2, to = 3"), Contains("stands instead of from and to"));
  CHECK_THAT(one(Fs + "distribution = \"gauss\", factor = 2"), Contains("normal"));
  CHECK_THAT(one(Fs + "distribution = \"log-uniform\", from = 0, to = 2"), Contains("must have the sign of to"));
  CHECK_THAT(one(Fs + "distribution = \"normal\""), Contains("deviation: is required"));
  CHECK_THAT(one(Fs + "distribution = \"normal\", deviation = -1"), Contains("must be > 0 N"));
  CHECK_THAT(one(Fs + "distribution = \"normal\", deviation = 1, from = 2"), Contains("must lie between from and to"));
  CHECK_THAT(one(Fs + "mean = 1, factor = 2"), Contains("is allowed only with distribution = \"normal\""));
  CHECK_THAT(one("path = \"loop.load\", factor = 2"), Contains("other than 0"));
  CHECK_THAT(message(with_spread("parameters = [{" + Fs + "factor = 2}, {" + Fs + "factor = 3}]\n")),
             Contains("stands in the list twice"));
}

TEST_CASE("sensitivity section: correlations") {
  const std::string both =
      "[sensitivity]\nparameters = [{path = \"loop.friction.Fs\", factor = 1.1}, {path = \"loop.friction.Fc\", factor "
      "= 1.1}]\n";
  const auto with_list = [&](const std::string& list) {
    return std::string(servo) + both + "correlation = " + list + "\n";
  };
  const std::string pair = "between = [\"loop.friction.Fc\", \"loop.friction.Fs\"]";
  const Case from = read_case(with_list("[{" + pair + ", value = 0.8}]"), "a.toml");
  REQUIRE(from.sensitivity->correlations.size() == 1);
  CHECK(from.sensitivity->correlations[0].one == 0);
  CHECK(from.sensitivity->correlations[0].other == 1);
  CHECK(from.sensitivity->correlations[0].value == 0.8);
  CHECK_THAT(message(with_list("[{" + pair + ", value = 1.0}]")), Contains("correlation[0].value = 1"));
  CHECK_THAT(message(with_list("[{" + pair + "}]")), Contains("value: is required"));
  CHECK_THAT(message(with_list("[{between = [\"loop.friction.Fs\"], value = 0.1}]")),
             Contains("a list of two parameters"));
  CHECK_THAT(message(with_list("[{between = [\"loop.friction.Fs\", \"loop.friction.Fs\"], value = 0.1}]")),
             Contains("two different parameters"));
  CHECK_THAT(message(with_list("[{between = [\"loop.friction.Fs\", \"loop.plant.mass\"], value = 0.1}]")),
             Contains("is not in the list of parameters"));
  CHECK_THAT(message(with_list("[{" + pair + ", value = 0.1}, {" + pair + ", value = 0.2}]")),
             Contains("stands in the list before"));
  CHECK_THAT(message(with_list("3")), Contains("must be a list of tables"));
}
