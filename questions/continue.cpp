#include "limcycle/questions/continue.hpp"

#include <cmath>

#include "limcycle/cases/loader/loop_variation.hpp"

namespace limcycle {

FollowReport ask_continue(const Case& from, const CaseNumber& number, double low, double high, const Asking& asking) {
  FollowOptions options;
  options.continuation.from = low;
  options.continuation.to = high;
  options.predict = from.predict;
  options.predict.stop = asking.stop;
  options.predict.progress = asking.progress;
  if (std::isfinite(number.value)) options.own = number.value;
  return follow(LoopVariation(from, "parameter", number.path), options);
}

}  // namespace limcycle
