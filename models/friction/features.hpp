#pragma once
#include <string_view>

namespace limcycle {

/// What a friction law remembers of its past motion. `local`: the present state alone, so that a closed minor loop
/// leaves a trace; `non_local`: the return points, wiped out when a minor loop closes (Madelung's rules).
enum class Memory { none, local, non_local };

/// What is known of a friction law beside its equation, for the table of laws. Every statement is held against the law
/// by the conformance tests as far as it can be computed.
struct Features {
  Memory memory = Memory::none;
  bool drifts = false;              ///< a bounded periodic force below Fc moves the body on, cycle by cycle
  std::string_view drift = {};      ///< that in words: where it does, where not
  std::string_view rate = {};       ///< what depends on the rate of motion
  std::string_view passivity = {};  ///< when it is passive from v to F
  std::string_view evidence = {};   ///< what of the published form was confirmed, what is reconstructed
};

/// Optional: a law whose force is a function of the path alone, however fast it is gone.
template <class E>
concept RateIndependent = requires {
  requires E::rate_independent;
};

constexpr std::string_view to_string(Memory memory) {
  return memory == Memory::none ? "none" : memory == Memory::local ? "local" : "non-local";
}

}  // namespace limcycle
