#pragma once
#include <pybind11/pybind11.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "limcycle/python/core/answer.hpp"

namespace limcycle::python {

/// What every question takes.
struct Work {
  std::uint64_t seed = 0;
  int threads = 1;  ///< 0: one a core
  Isa isa = best_isa();
  double time_limit = 0.0;    ///< s; 0: none
  pybind11::object progress;  ///< called with (fraction, what), at most 20 times a second; or None
};

/// Works on a question on a thread of its own, without the interpreter's lock, while this one watches for Ctrl-C and
/// the time limit and calls `progress`. An interrupt, and an exception of `progress`, ends the work within the time of
/// one of its steps and is thrown here.
Answer answer_to(const std::shared_ptr<const Case>& from, const Work& work,
                 const std::function<Answer(const Question&)>& ask);

}  // namespace limcycle::python
