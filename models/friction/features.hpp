#pragma once
#include <string_view>

namespace limcycle {

/// Memory of a friction law. `local`: the present state only, so that a closed minor loop leaves a trace; `non_local`:
/// the return points, wiped out when a minor loop closes (Madelung's rules).
enum class Memory { none, local, non_local };

/// Properties of a friction law beyond its equation, for the table of laws. The conformance tests check every statement
/// against the law as far as it can be computed.
struct Features {
  Memory memory = Memory::none;
  bool drifts = false;              ///< a bounded periodic force below Fc moves the body, cycle by cycle
  std::string_view drift = {};      ///< the same in words: under which conditions
  std::string_view rate = {};       ///< what depends on the rate of motion
  std::string_view passivity = {};  ///< when it is passive from v to F
  std::string_view evidence = {};   ///< which parts of the published form are confirmed, which are reconstructed
};

/// Optional: a law whose force is a function of the path alone, at any speed.
template <class E>
concept RateIndependent = requires {
  requires E::rate_independent;
};

constexpr std::string_view to_string(Memory memory) {
  return memory == Memory::none ? "none" : memory == Memory::local ? "local" : "non-local";
}

}  // namespace limcycle
