#include "limcycle/analysis/study/predict/work_share.hpp"

#include <algorithm>

namespace limcycle {

WorkShare work_share(long steps) {
  const auto share = [steps](long times, long least, long most) { return std::clamp(times * steps, least, most); };
  return {.between_steps = share(4, 200'000, 1'000'000),
          .composite_steps = share(4, 500'000, 1'500'000),
          .df_evaluations = share(100, 30'000'000, 40'000'000),
          .check_steps = share(4, 200'000, 2'000'000),
          .balance_evaluations = share(10, 1'000'000, 2'000'000)};
}

}  // namespace limcycle
