#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "limcycle/analysis/study/tune/tune_judge.hpp"
#include "limcycle/analysis/study/tune/tune_space.hpp"

namespace limcycle {

/// What a local search tried.
struct LocalSearch {
  std::vector<TunePoint> points = {};
  std::optional<std::size_t> reached = {};  ///< the best of them; empty: none is better than the start
  std::size_t judged = 0;                   ///< points that were asked whether they hunt
  bool ended = false;                       ///< by its own criterion, not by its limit of judgements or a stop
};

/// A DirectSearch, the `number`-th, from a feasible one of the points that are known. The points of a poll are looked
/// at, those with a lower cost judged until one does not hunt, in the order of cost, but last those whose nearest
/// judged neighbour is not feasible. Points within half a step of one that is not are taken to be like it. No point is
/// tried twice, and at most 40 are judged.
LocalSearch search_from(const std::vector<TunePoint>& known, std::size_t start, std::size_t number,
                        const TuneSpace& space, const TuneQuestion& question, std::uint64_t seed);

}  // namespace limcycle
