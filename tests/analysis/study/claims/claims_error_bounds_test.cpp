#include <algorithm>

#include "limcycle/tests/analysis/study/claims/claims_testing.hpp"

using namespace limcycle;
using namespace limcycle::test;

TEST_CASE("claims C: the error bounds hold for cycles found by shooting") {
  check_list(error_bound_claims(), {"C1", "C2", "C3", "C4"}, 4);
}

TEST_CASE("claims C: the bounds say something: some cycle uses more than a tenth of them") {
  for (const char* id : {"C1", "C4"}) {
    CAPTURE(id);
    const auto result = claim(error_bound_claims(), id).run(at_random(6));
    const auto uses = [](const ClaimCheck& check) {
      return check.quantity.ends_with("<= claimed") && check.computed > 0.1 * check.claimed;
    };
    CHECK(std::ranges::any_of(result.checks, uses));
  }
}
