#include "limcycle/analysis/study/predict/in_exact_time.hpp"

#include <stdexcept>

#include "limcycle/models/delay.hpp"

namespace limcycle {

std::optional<Loop> in_exact_time(const Loop& loop) {
  if (loop.sampled) return std::nullopt;
  if (loop.delay == 0.0) return loop;
  try {
    TimeDomainLoop treated = in_time_domain(loop, lowest_pade_order);
    return treated.pade_order == 0 ? std::optional(std::move(treated.loop)) : std::nullopt;
  } catch (const std::invalid_argument&) {  // loops that the approximation, not used here, rejects
    return std::nullopt;
  }
}

LoopFamily in_exact_time(LoopFamily family) {
  return [family = std::move(family)](double parameter) -> std::optional<Loop> {
    const auto loop = family(parameter);
    return loop ? in_exact_time(*loop) : std::nullopt;
  };
}

std::string_view why_not_followed(const Loop& loop) {
  if (loop.sampled)
    return "with a sampled controller a limit cycle changes in steps of the samples, if it has a period at all, so it "
           "cannot be followed";
  return "the dead time of this loop is exact in the time domain only behind a relay, so its limit cycles cannot be "
         "followed";
}

}  // namespace limcycle
