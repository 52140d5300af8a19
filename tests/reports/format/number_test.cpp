#include "limcycle/reports/format/number.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace limcycle;

namespace {

const double nan_value = std::numeric_limits<double>::quiet_NaN();
const double inf_value = std::numeric_limits<double>::infinity();

/// One unit in the last decimal place that a printed number shows.
double last_unit(const std::string& text) {
  const auto e = text.find('e');
  const std::string mantissa = text.substr(0, e);
  const auto point = mantissa.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
  return std::pow(10.0, (e == std::string::npos ? 0 : std::stoi(text.substr(e + 1))) - decimals);
}

}  // namespace

TEST_CASE("shortest reads back as the same double") {
  CHECK(shortest(0.1) == "0.1");
  CHECK(shortest(24.436786455993) == "24.436786455993");
  CHECK(shortest(nan_value).empty());
  CHECK(shortest(-inf_value).empty());
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0), exponent(-300.0, 300.0);
  for (int i = 0; i < 1000; ++i) {
    const double value = mantissa(random) * std::pow(10.0, exponent(random));
    REQUIRE(std::stod(shortest(value)) == value);
  }
}

TEST_CASE("a fixed number of digits") {
  CHECK(with_digits(24.436786, 4) == "24.44");
  CHECK(with_digits(9.996, 3) == "10.0");
  CHECK(with_digits(0.0001234, 3) == "0.000123");
  CHECK(with_digits(0.00001234, 3) == "1.23e-05");
  CHECK(with_digits(123456.0, 3) == "123456");
  CHECK(with_digits(1.5e8, 3) == "1.50e+08");
  CHECK(with_digits(-0.5, 2) == "-0.50");
  CHECK(with_digits(0.0, 5) == "0");
  CHECK(with_digits(nan_value, 3) == "-");
  CHECK(with_digits(inf_value, 3) == "-");
}

TEST_CASE("as many digits as are right") {
  CHECK(with_error(24.436786455993, 1e-10) == "24.436786456");
  CHECK(with_error(24.436786455993, 1e-4) == "24.437");
  CHECK(with_error(24.436786455993, 3e-3) == "24.4");
  CHECK(with_error(24.436786455993, 0.5) == "24");
  CHECK(with_error(24.436786455993, 0.0) == "24.4367864560");
  CHECK(with_error(24.436786455993, nan_value) == "24.44");
  CHECK(with_error(24.436786455993, inf_value) == "24.44");
  CHECK(with_error(123456.0, 0.01) == "1.23e+05");
  CHECK(with_error(9.99996, 1e-3) == "10.00");
  CHECK(with_error(nan_value, 1e-3) == "-");
  CHECK(with_error(0.0, 1e-3) == "0");
}

TEST_CASE("the digits shown follow the error, neither more nor fewer") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> mantissa(1.0, 10.0), exponent(-8.0, 8.0), accuracy(-10.0, -1.5);
  for (int i = 0; i < 1000; ++i) {
    const double value = mantissa(random) * std::pow(10.0, exponent(random));
    const double relative = std::pow(10.0, accuracy(random));
    const std::string text = with_error(value, relative);
    const double error = relative * value, unit = last_unit(text);
    CAPTURE(value, relative, text);
    REQUIRE(error <= 5.0000001 * unit);
    REQUIRE(error >= 0.4999999 * unit);
    REQUIRE(std::abs(std::stod(text) - value) <= 0.5000001 * unit);
  }
}

TEST_CASE("a mean within its error is nothing") {
  CHECK(with_absolute_error(1e-14, 1e-12) == "0");
  CHECK(with_absolute_error(0.0, 0.0) == "0");
  CHECK(with_absolute_error(0.25, 1e-4) == "0.2500");
  CHECK(with_absolute_error(nan_value, 1e-4) == "-");
}

TEST_CASE("errors and shares") {
  CHECK(as_error(1.23e-10) == "1.2e-10");
  CHECK(as_error(0.0) == "0");
  CHECK(as_error(nan_value) == "-");
  CHECK(as_percent(0.0) == "0 %");
  CHECK(as_percent(1.0) == "100 %");
  CHECK(as_percent(0.6213) == "62.1 %");
  CHECK(as_percent(1e-9) == "<0.1 %");
  CHECK(as_percent(1.0 - 1e-9) == ">99.9 %");
  CHECK(as_percent(nan_value) == "-");
}
