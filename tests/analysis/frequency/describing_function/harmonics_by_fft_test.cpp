#include "limcycle/analysis/frequency/describing_function/harmonics_by_fft.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace limcycle;

TEST_CASE("FFT harmonics of a trigonometric polynomial are its coefficients", "[df][fft]") {
  for (const double origin : {0.0, 1.234}) {
    for (const int count : {16, 60, 256}) {
      std::vector<double> samples;
      for (int j = 0; j < count; ++j) {
        const double t = origin + 2.0 * std::numbers::pi * j / count;
        samples.push_back(0.7 + 2.0 * std::sin(t) - 0.5 * std::cos(t) + 0.25 * std::cos(3.0 * t) -
                          3.0 * std::sin(5.0 * t));
      }
      const auto harmonics = harmonics_by_fft(samples, origin, 5);
      REQUIRE(harmonics.size() == 6);
      CHECK(harmonics[0].imag() == Approx(0.7));
      const std::complex<double> expected[] = {{2.0, -0.5}, {0.0, 0.0}, {0.0, 0.25}, {0.0, 0.0}, {-3.0, 0.0}};
      for (std::size_t k = 1; k <= 5; ++k) CHECK(std::abs(harmonics[k] - expected[k - 1]) < 1e-14);
    }
  }
  CHECK_THROWS_AS(harmonics_by_fft(std::vector<double>(10), 0.0, 5), std::invalid_argument);
}
