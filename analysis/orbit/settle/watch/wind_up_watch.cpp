#include "limcycle/analysis/orbit/settle/watch/wind_up_watch.hpp"

#include <cmath>
#include <utility>

namespace limcycle {

WindUpWatch::WindUpWatch(const Loop& loop) {
  for (std::size_t i = 0; i < loop.elements.size(); ++i)
    if (loop.ports[i].rubs && loop.elements[i].states() > 0) rubs_ = i;
  if (rubs_) size_ = loop.elements[*rubs_].scales().output;
}

std::optional<double> WindUpWatch::read(double t, const LoopField& field) {
  if (!rubs_ || ++readings_ % window != 0) return std::nullopt;
  constexpr double steady = 0.01;
  const double force = field.output(*rubs_);
  const auto before = std::exchange(before_, force);
  const double since = std::exchange(since_, t);
  if (!before || !(t > since)) return std::nullopt;
  const double rate = (force - *before) / (t - since);
  const auto last_rate = std::exchange(slope_, rate);
  const bool grows = force * rate > 0.0 && std::abs(force) < size_;
  if (!grows || !last_rate || std::abs(rate - *last_rate) > steady * std::abs(rate)) return std::nullopt;
  return t + (size_ - std::abs(force)) / std::abs(rate);
}

}  // namespace limcycle
