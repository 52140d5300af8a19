#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"

#include <stdexcept>

namespace limcycle {

std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9E3779B97F4A7C15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

RandomStream::RandomStream(std::uint64_t seed, std::string_view purpose, std::uint64_t number) {
  std::uint64_t name = 0xCBF29CE484222325U;  // FNV-1a, 64 bits
  for (const char letter : purpose) name = (name ^ static_cast<unsigned char>(letter)) * 0x100000001B3U;
  // Each of the three is mixed before the next one is added, so that no two of them can cancel each other.
  state_ = seed;
  state_ = splitmix64(state_) ^ name;
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
