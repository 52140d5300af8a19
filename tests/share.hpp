#pragma once
#include <algorithm>
#include <vector>

#include "limcycle/tests/setting.hpp"

/// How much of a repeated test is done. In a sanitizer run a repetition takes three to ten times as long and finds
/// hardly more than the first: one in six is done there, and all of them elsewhere. No test is left out.
namespace limcycle::test {

inline int one_in() { return sanitized() ? 6 : 1; }

/// This many of `all` random samples, at least one.
inline int samples(int all) { return std::max(1, all / one_in()); }

/// True for the repetitions that are done: of number 0, 1, 2, ...
inline bool is_done(int number) { return number % one_in() == 0; }

/// Those of a list that are done.
template <class List>
List some_of(List list) {
  int number = 0;
  std::erase_if(list, [&](const auto&) { return !is_done(number++); });
  return list;
}

}  // namespace limcycle::test
