#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"

#include <stdexcept>

namespace limcycle {

RandomStream::RandomStream(std::uint64_t seed, std::string_view purpose, std::uint64_t number) {
  // Each of the three is mixed before the next one is added, so that no two of them can cancel each other.
  state_ = seed;
  state_ = splitmix64(state_) ^ fnv1a(purpose);
  state_ = splitmix64(state_) ^ number;
  state_ = splitmix64(state_);
}

double RandomStream::uniform() { return (static_cast<double>(bits() >> 12U) + 0.5) * 0x1p-52; }

std::size_t RandomStream::below(std::size_t n) {
  if (n == 0) throw std::invalid_argument("there is no whole number below 0");
  const std::uint64_t range = n, surplus = (0 - range) % range;  // 2^64 modulo n
  for (;;)
    if (const std::uint64_t drawn = bits(); drawn >= surplus) return static_cast<std::size_t>(drawn % range);
}

}  // namespace limcycle
