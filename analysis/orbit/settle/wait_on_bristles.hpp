#pragma once
#include <functional>
#include <optional>

#include "limcycle/analysis/orbit/settle/watch/stillness_watch.hpp"
#include "limcycle/analysis/orbit/settle/watch/wind_up_watch.hpp"

namespace limcycle {

/// The end of a long wait.
struct WaitOnBristles {
  double time = 0.0;                ///< of the wait, s
  std::optional<Stillness> still;   ///< the body comes to rest
  std::optional<LoopState> resume;  ///< else the state shortly before it breaks away
  long steps = 0;
};

/// Follows a body that stays on the bristles of element `rubs` while a sampled controller winds up, in the loop with
/// the continuous controller (Loop::continuous), in a few hundred steps instead of millions of samples. In such a wait
/// both controllers integrate the same error: they differ by the ripple of a sample and by quanta, of which the force
/// is made of many. A body that breaks away is handed back to the samples with the last state in which its force is
/// below 98 % of its typical size. Empty if there is none, or if neither happens within `most_steps` steps.
std::optional<WaitOnBristles> wait_on_bristles(const Loop& loop, const LoopState& here, std::size_t rubs, double rtol,
                                               long most_steps, const std::function<bool()>& stop);

}  // namespace limcycle
