#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "limcycle/analysis/random_bits.hpp"

namespace limcycle {

/// Random numbers that are the same on every machine: a seed of the user, a purpose, and a number (such as that of a
/// trajectory) give a stream of their own. Draws for one purpose do not affect those for another. (The distributions of
/// the standard library differ from one library to the next.)
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view purpose, std::uint64_t number = 0);

  std::uint64_t bits() { return splitmix64(state_); }
  /// Uniform in (0, 1), never 0 or 1: the middles of 2^52 equal cells.
  double uniform();
  /// 0 .. n-1, all equally likely. Throws std::invalid_argument for n = 0.
  std::size_t below(std::size_t n);

 private:
  std::uint64_t state_;
};

}  // namespace limcycle
