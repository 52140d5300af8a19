#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/claims/run_claims.hpp"
#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/cases/loader/text/formula.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using limcycle::test::message;
using limcycle::test::servo;

namespace {

/// The servo of 19 lines with a claim; the body begins in line 22.
std::string with_claim(const std::string& body) { return std::string(servo) + "[[claim]]\nid = \"a\"\n" + body; }

/// Relay with hysteresis and an integrator: period 4 h/(gain level), amplitude h.
const std::string relay_case = R"([loop.plant]
kind = "zpk"
zeros = []
poles = [0.0]
gain = 2.0
[loop.element]
kind = "relay"
level = 1.0
hysteresis = 0.1
[search]
amplitude = [1e-3, 10.0]
frequency = [0.1, 1000.0]
)";

const std::string coulomb = "[loop.friction]\nkind = \"coulomb\"\nFc = 2.0\n";

/// Result of one claim; `random_points` are those of the claim itself.
TestedClaim tested(const std::string& loop, const std::string& body) {
  const Case from = read_case(loop + "[[claim]]\nid = \"a\"\n" + body, "a.toml");
  const auto result = run_claims(claims_of(from), {});
  REQUIRE(result.size() == 1);
  return result[0];
}
ClaimVerdict verdict(const std::string& loop, const std::string& body) { return tested(loop, body).result.verdict; }

}  // namespace

TEST_CASE("formula: numbers, names, pi to the last digit, and what is wrong with one") {
  using case_file::FormulaError;
  using case_file::value_of_formula;
  CHECK(value_of_formula("4*Fs/(pi*A)", {{"Fs", 1.5}, {"A", 2.0}}) == 4.0 * 1.5 / (std::numbers::pi * 2.0));
  CHECK(value_of_formula("sqrt(2)^2 > 1 ? 3 : 4", {}) == 3.0);
  CHECK(std::isinf(value_of_formula("1/0", {})));
  const auto wrong = [](const std::string& formula) {
    try {
      value_of_formula(formula, {{"Fs", 1.5}});
    } catch (const FormulaError& error) {
      return std::string(error.what()) + "|" + error.token;
    }
    return std::string();
  };
  CHECK(wrong("4*Fx") == "unknown name 'Fx' in the formula, at position 3|Fx");
  CHECK_THAT(wrong("4*("), Contains("is not a formula") && Contains("position"));
  CHECK_THAT(wrong(""), Contains("is not a formula"));
  CHECK_THAT(wrong("Fs = 3"), Contains("is not a formula"));
  CHECK_THAT(wrong("1, 2"), Contains("several values"));
  CHECK_THAT(wrong("_pi"), Contains("unknown name"));
}

TEST_CASE("section claim: what it holds") {
  const Case from = read_case(
      with_claim("statement = \"s\"\nsource = \"me\"\nquantity = \"gain.imag\"\ncomparison = \">=\"\n"
                 "formula = \"4*Fc/(pi*A) + friction_sigma2*w\"\nexpected = \"fails\"\n"
                 "at = {amplitude = 0.01, frequency = 2}\nover = [{path = \"at.amplitude\", from = 0.1, to = 1}, "
                 "{path = \"loop.friction.Fs\", factor = 2}]\nrandom = 3\n") +
          "[[claim]]\nid = \"b\"\nquantity = \"period\"\nformula = 24.4\ntolerance = 0.1\n",
      "a.toml");
  REQUIRE(from.claims.size() == 2);
  const UserClaim& a = from.claims[0];
  CHECK(a.statement == "s");
  CHECK(a.comparison == Comparison::at_least);
  CHECK(a.expected == ClaimVerdict::fails);
  REQUIRE(a.at);
  CHECK(a.at->frequency == 2.0);
  CHECK(a.over.size() == 2);
  CHECK(a.random_points == 3);
  CHECK(from.claims[1].comparison == Comparison::equal);
  CHECK(from.claims[1].tolerance == 0.1);
  const auto claims = claims_of(from);
  CHECK(claims[0].source == "me");
  CHECK(claims[1].source == "case file a.toml");
  CHECK(claims[1].statement == "period = 24.4");
}

TEST_CASE("section claim: what is refused, with line, key, value and rule") {
  const auto said = [](const std::string& body) { return message(with_claim(body)); };
  CHECK(said("quantity = \"periode\"\nformula = \"1\"\n") ==
        "a.toml:22: claim[0].quantity = \"periode\": must be one of \"period\", \"amplitude\", \"frequency\", "
        "\"offset\", "
        "\"first_harmonic\", \"sticking_fraction\", \"largest_multiplier\", \"cycles\", \"hunts\", \"gain.real\", "
        "\"gain.imag\", \"dissipation\", \"mean\", \"passive\", \"threshold.sigma2\", \"state_bound\", "
        "\"force_bound\"; did you mean \"period\"?");
  CHECK(said("quantity = \"period\"\nformula = \"4*Fss\"\n") ==
        "a.toml:23: claim[0].formula = \"4*Fss\": unknown name 'Fss' in the formula, at position 3; did you mean Fs?");
  CHECK_THAT(said("quantity = \"period\"\nformula = \"4*(Fs\"\n"),
             Contains("a.toml:23: claim[0].formula = \"4*(Fs\": is not a formula: ") && Contains("(at position "));
  CHECK_THAT(said("quantity = \"period\"\n"), Contains("claim[0].formula: is required"));
  CHECK_THAT(said("formula = \"1\"\n"), Contains("claim[0].quantity: is required"));
  CHECK_THAT(said("quantity = \"period\"\nformula = true\n"), Contains("must be a string, found a boolean"));
  CHECK_THAT(said("quantity = \"gain.real\"\nformula = \"1\"\n"), Contains("claim[0].at: is required"));
  CHECK_THAT(said("quantity = \"period\"\nformula = \"A\"\n"), Contains("unknown name 'A'"));
  CHECK_THAT(said("quantity = \"period\"\nformula = \"1\"\nat = {amplitude = 1, frequency = 1}\n"),
             Contains("claim[0].at") && Contains("is allowed only with describing functions"));
  CHECK_THAT(said("quantity = \"period\"\nformula = \"1\"\nrandom = 3\n"), Contains("needs over"));
  CHECK_THAT(said("quantity = \"period\"\nformula = \"1\"\ncomparison = \"<\"\ntolerance = 0.1\n"),
             Contains("is allowed only with comparison"));
  CHECK_THAT(said("quantity = \"period\"\nformula = \"1\"\ncomparison = \"==\"\n"), Contains("must be one of \"=\""));
  CHECK_THAT(said("quantity = \"period\"\nformula = \"1\"\nexpected = \"true\"\n"),
             Contains("must be one of \"holds\""));
  CHECK_THAT(said("quantity = \"period\"\nformula = \"1\"\nover = [{path = \"loop.friction.F\", factor = 2}]\n"),
             Contains("is not a parameter") && Contains("claim[0].over[0].path"));
  CHECK_THAT(said("quantity = \"period\"\nformula = \"1\"\nformla = 1\n"), Contains("did you mean formula?"));
  CHECK_THAT(said("quantity = \"period\"\nformula = \"1\"\n[[claim]]\nid = \"a\"\nquantity = \"hunts\"\nformula = 1\n"),
             Contains("claim[1].id") && Contains("appears twice in the case"));
  CHECK_THAT(message(coulomb + "[[claim]]\nid = \"a\"\nquantity = \"period\"\nformula = \"1\"\n"),
             Contains("needs a loop"));
  CHECK_THAT(message(relay_case + "[[claim]]\nid = \"a\"\nquantity = \"passive\"\nformula = \"1\"\n"),
             Contains("the loop has none"));
  CHECK(message("claim = [1]\n" + coulomb) == "a.toml:1: claim[0] = 1: must be a table, found a number");
}

TEST_CASE("section claim: a key of two sections needs the section's name") {
  const std::string two =
      "[loop.plant]\nkind = \"two-mass\"\nmotor_mass = 1\nload_mass = 1\nstiffness = 3\n" +
      std::string("[loop.controller]\nkind = \"pid\"\nkp = 1\nkd = 1\nsaturation = 5\n") +
      "[loop.element]\nkind = "
      "\"saturation\"\nlimit = 1\nslope = 1\n[[claim]]\nid = \"a\"\nquantity = \"hunts\"\nformula = ";
  CHECK(message(two + "\"plant_stiffness*0\"\n").empty());
  CHECK(message(two + "\"stiffness*0\"\n").empty());
  CHECK_THAT(message(two + "\"slop*0\"\n"), Contains("did you mean slope?"));
}

TEST_CASE("user claims: a cycle known in closed form, at random parameters too") {
  const std::string over =
      "over = [{path = \"loop.element.hysteresis\", from = 0.05, to = 0.2}, {path = \"loop.plant.gain\", from = 1, to "
      "= "
      "3}]\nrandom = 3\n";
  const auto period =
      tested(relay_case, "quantity = \"period\"\nformula = \"4*hysteresis/(gain*level)\"\ntolerance = 1e-8\n" + over);
  CHECK(period.result.verdict == ClaimVerdict::holds);
  CHECK(period.result.checks.size() == 4);
  CHECK(period.result.checks[3].random);
  CHECK(period.result.checks[3].claimed != period.result.checks[0].claimed);
  CHECK(verdict(relay_case, "quantity = \"period\"\nformula = \"4.001*hysteresis/(gain*level)\"\ntolerance = 1e-4\n") ==
        ClaimVerdict::fails);
  CHECK(verdict(relay_case, "quantity = \"amplitude\"\nformula = \"hysteresis\"\ntolerance = 1e-8\n") ==
        ClaimVerdict::holds);
  CHECK(verdict(relay_case, "quantity = \"amplitude\"\nformula = \"0.11\"\ncomparison = \"<\"\n") ==
        ClaimVerdict::holds);
  CHECK(verdict(relay_case, "quantity = \"amplitude\"\nformula = \"0.09\"\ncomparison = \"<=\"\n") ==
        ClaimVerdict::fails);
  CHECK(verdict(relay_case, "quantity = \"hunts\"\nformula = 1\n") == ClaimVerdict::holds);
  CHECK(verdict(relay_case, "quantity = \"hunts\"\ncomparison = \"<\"\nformula = 1\n") == ClaimVerdict::fails);
  // The root is at the least amplitude for which N exists: the search may have missed others, so the count is open.
  CHECK(verdict(relay_case, "quantity = \"cycles\"\nformula = 1\n") == ClaimVerdict::undecided);
  const std::string lags =
      "[loop.plant]\nkind = \"zpk\"\nzeros = []\npoles = [-1, -1, -1]\ngain = 1\n[loop.element]\n"
      "kind = \"relay\"\nlevel = 1\n[search]\namplitude = [0.01, 1]\nfrequency = [0.1, 10]\n";
  CHECK(verdict(lags, "quantity = \"cycles\"\nformula = 1\n") == ClaimVerdict::holds);
  CHECK(verdict(lags, "quantity = \"cycles\"\nformula = 2\n") == ClaimVerdict::fails);
  CHECK(verdict(relay_case, "quantity = \"largest_multiplier\"\ncomparison = \"<\"\nformula = 1\n") ==
        ClaimVerdict::holds);
  CHECK(verdict(relay_case, "quantity = \"offset\"\nformula = 0\n") == ClaimVerdict::holds);
  CHECK(verdict(relay_case, "quantity = \"sticking_fraction\"\nformula = 0\n") == ClaimVerdict::holds);
  // The frequency by the describing function, 4 gain level/(pi h), is 19 % off.
  const auto df =
      tested(relay_case,
             "quantity = \"frequency\"\nformula = \"4*gain*level/(pi*hysteresis)\"\ntolerance = 0.05\nexpected = "
             "\"fails\"\n");
  CHECK(df.as_expected());
  CHECK(df.result.checks[0].computed == Approx(10.0 * std::numbers::pi));
}

TEST_CASE("user claims: where there is no cycle, claims of one fail, without a NaN") {
  const std::string rests =
      "[loop.plant]\nkind = \"mass\"\nmass = 1\n[loop.controller]\nkind = \"pid\"\nkp = 1\nkd = 1\n"
      "[loop.friction]\nkind = \"coulomb\"\nFc = 1\n";
  const auto period = tested(rests, "quantity = \"period\"\ncomparison = \"<\"\nformula = 10\n");
  CHECK(period.result.verdict == ClaimVerdict::fails);
  CHECK(period.result.checks[0].quantity == "there is a stable limit cycle");
  CHECK(verdict(rests, "quantity = \"hunts\"\nformula = 0\n") == ClaimVerdict::holds);
  CHECK(verdict(rests, "quantity = \"cycles\"\nformula = 0\n") == ClaimVerdict::holds);
  // A formula without a value disproves nothing.
  CHECK(verdict(rests, "quantity = \"hunts\"\nformula = \"0/0\"\n") == ClaimVerdict::undecided);
}

TEST_CASE("user claims: describing functions, of a lone law too") {
  const std::string at = "at = {amplitude = 0.5, frequency = 2}\n";
  const std::string over =
      "over = [{path = \"at.amplitude\", distribution = \"log-uniform\", from = 0.01, to = 10}, "
      "{path = \"loop.friction.Fc\", from = 1, to = 3}]\n";
  CHECK(verdict(coulomb, "quantity = \"gain.imag\"\nformula = \"4*Fc/(pi*A)\"\n" + at + over) == ClaimVerdict::holds);
  CHECK(verdict(coulomb, "quantity = \"gain.imag\"\nformula = \"4.0001*Fc/(pi*A)\"\n" + at) == ClaimVerdict::fails);
  CHECK(verdict(coulomb, "quantity = \"gain.real\"\nformula = \"0\"\n" + at) == ClaimVerdict::holds);
  CHECK(verdict(coulomb, "quantity = \"dissipation\"\nformula = \"4*Fc*A\"\n" + at + over) == ClaimVerdict::holds);
  const std::string biased = "at = {amplitude = 0.5, frequency = 2, bias = 0.3}\n";
  CHECK(verdict(coulomb, "quantity = \"mean\"\nformula = \"2*Fc/pi*asin(bias/(A*w))\"\ntolerance = 1e-6\n" + biased) ==
        ClaimVerdict::holds);
}

TEST_CASE("user claims: passivity and bounds of a law") {
  const std::string lugre =
      "[loop.friction]\nkind = \"lugre\"\nFs = 1.5\nFc = 1\nvs = 1e-3\nsigma0 = 1e5\nsigma1 = 316\n";
  const std::string over =
      "over = [{path = \"loop.friction.Fs\", from = 1.1, to = 2}, {path = \"loop.friction.sigma1\", "
      "factor = 2}]\nrandom = 3\n";
  CHECK(verdict(lugre, "quantity = \"threshold.sigma2\"\nformula = \"sigma1*(Fs - Fc)/Fc\"\n" + over) ==
        ClaimVerdict::holds);
  CHECK(verdict(lugre, "quantity = \"threshold.sigma2\"\nformula = \"sigma1*(Fs - Fc)/Fs\"\n") == ClaimVerdict::fails);
  CHECK(verdict(lugre, "quantity = \"passive\"\nformula = 0\n") == ClaimVerdict::holds);
  CHECK(verdict(lugre, "quantity = \"state_bound\"\nformula = \"Fs/sigma0\"\n" + over) == ClaimVerdict::holds);
  CHECK(verdict(lugre, "quantity = \"force_bound\"\ncomparison = \"<=\"\nformula = 1000\n") == ClaimVerdict::fails);
  CHECK(verdict(coulomb, "quantity = \"passive\"\nformula = 1\n") == ClaimVerdict::holds);
}

TEST_CASE("the numbers of a case that holds a lone law") {
  const auto numbers = numbers_of(read_case(coulomb, "a.toml"));
  REQUIRE(numbers.size() >= 2);
  CHECK(numbers[0].path == "loop.friction.Fc");
  const std::pair<std::string, double> change("loop.friction.Fc", 3.0);
  REQUIRE(case_with(read_case(coulomb, "a.toml"), std::span(&change, 1)));
  CHECK(law_of<Coulomb<double>>(*case_with(read_case(coulomb, "a.toml"), std::span(&change, 1))->element).Fc == 3.0);
}
