#include <catch2/catch.hpp>
#include <string>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/models/loop.hpp"
#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// An axis under a PD law with a filter of these keys in between.
std::string with_filter(const std::string& keys) {
  return R"([diagram]
output = "axis.y"
[[diagram.block]]
name = "pd"
kind = "pid"
input = "r - axis.y"
kp = 30.0
kd = 6.0
sample_time = 0.002
[[diagram.block]]
name = "filter"
input = "pd"
)" + keys +
         R"(
[[diagram.block]]
name = "axis"
kind = "mass"
input = "filter"
mass = 2.0
[[diagram.block]]
name = "friction"
kind = "coulomb"
on = "axis"
Fc = 1.0
)";
}

}  // namespace

TEST_CASE("sampled blocks: a filter with a sample_time is part of the controller, of whatever kind it is") {
  for (const char* kind :
       {"kind = \"low-pass\"\ntime_constant = 0.01", "kind = \"notch\"\nfrequency = 60.0\ndamping = 0.4",
        "kind = \"lead-lag\"\nlead = 0.1\nlag = 0.01", "kind = \"gain\"\ngain = 2.0",
        "kind = \"integrator\"\nleak = 3.0",
        "kind = \"transfer-function\"\nnumerator = [1.0]\ndenominator = [0.01, 1.0]"}) {
    INFO(kind);
    const Case plain = read_case(with_filter(kind), "a.toml"),
               sampled = read_case(with_filter(std::string(kind) + "\nsample_time = 0.004"), "a.toml");
    CHECK(build_loop(*plain.loop).sampled->elements.size() == 2);
    const Loop loop = build_loop(*sampled.loop);
    REQUIRE(loop.sampled);
    CHECK(loop.sampled->elements.size() == 3);
    CHECK(loop.sampled->states() == 2);
  }
}

TEST_CASE("sampled blocks: what breaks a rule is refused with its key") {
  const std::string filter = "kind = \"low-pass\"\ntime_constant = 0.01\n";
  const auto said = [](const std::string& keys) { return message(with_filter(keys)); };
  CHECK(said(filter + "sample_time = 0.003").find("whole multiple of the shortest") != std::string::npos);
  CHECK(said(filter + "computation_delay = 0.001").find("needs sample_time") != std::string::npos);
  CHECK(said(filter + "sample_time = -1.0").find("diagram.filter.sample_time") != std::string::npos);
  CHECK(said("kind = \"sum\"\nsample_time = 0.002").find("diagram.filter.sample_time") != std::string::npos);
  CHECK(said("kind = \"transfer-function\"\nnumerator = [1.0]\ndenominator = [0.01, 1.0]\ndelay = 0.1\nsample_time = "
             "0.002")
            .find("let it be a block of its own") != std::string::npos);
}
