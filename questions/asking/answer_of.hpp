#pragma once
#include <stdexcept>
#include <string>

namespace limcycle {

/// A valid case with numbers that no method can handle, or a result that does not hold what is wanted of it.
class NoAnswer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Result of compute(). A method that rejects a valid case is no error of the input: throws NoAnswer with its message.
template <class Compute>
auto answer_of(const Compute& compute) {
  try {
    return compute();
  } catch (const std::invalid_argument& refused) {
    throw NoAnswer(std::string("this case is valid, but could not be computed: ") + refused.what());
  }
}

}  // namespace limcycle
