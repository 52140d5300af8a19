#include "limcycle/analysis/study/claims/friction/friction_claims.hpp"
#include "limcycle/tests/analysis/study/claims/claims_testing.hpp"

using namespace limcycle;
using namespace limcycle::test;

TEST_CASE("claims D: all hold, at the printed points and at random ones") {
  check_list(friction_claims(), {"D1", "D2", "D2b", "D3", "D4", "D5", "D6", "D7", "D8", "D9", "D10", "D11", "D12"}, 2);
}

TEST_CASE("claims D: in the order of their numbers") {
  const auto list = friction_claims();
  CHECK(list.front().id == "D1");
  CHECK(list.back().id == "D12");
}

TEST_CASE("claims: values of a law that nobody compares") {
  CHECK(compared_setting("lugre").number("Fs") == 1.5);
  CHECK_THROWS_WITH(compared_setting("no such law"), Catch::Matchers::Contains("no such law"));
}
