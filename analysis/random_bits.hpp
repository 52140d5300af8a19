#pragma once
#include <cstdint>
#include <ranges>

namespace limcycle {

inline constexpr std::uint64_t fnv_start = 0xcbf29ce484222325U;

/// FNV-1a of 64 bits over bytes: the same on every machine, which std::hash need not be (Fowler, Noll, Vo 1991).
template <std::ranges::input_range Bytes>
std::uint64_t fnv1a(const Bytes& bytes, std::uint64_t start = fnv_start) {
  for (const auto byte : bytes) start = (start ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  return start;
}

/// One step of SplitMix64: advances the state and gives 64 bits. G. L. Steele, D. Lea, C. H. Flood, Fast splittable
/// pseudorandom number generators, OOPSLA 2014; constants of S. Vigna's public-domain version.
inline std::uint64_t splitmix64(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

}  // namespace limcycle
