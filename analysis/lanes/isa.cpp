#include "limcycle/analysis/lanes/isa.hpp"

#include <algorithm>
#include <array>

namespace limcycle {

namespace {

constexpr std::array<Isa, 3> sets{Isa::scalar, Isa::avx2, Isa::avx512};

}  // namespace

std::span<const Isa> all_isas() { return sets; }

std::string_view to_string(Isa isa) {
#if defined(__x86_64__)
  return isa == Isa::avx512 ? "x86-64-v4" : isa == Isa::avx2 ? "x86-64-v3" : "x86-64";
#else
  return isa == Isa::avx512 ? "x86-64-v4" : isa == Isa::avx2 ? "x86-64-v3" : "portable";
#endif
}

bool is_available(Isa isa) {
#if defined(__x86_64__) && defined(__GNUC__)
  // Includes the operating system's support: registers that it does not save cannot be used.
  if (isa == Isa::avx2) return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  if (isa == Isa::avx512)
    return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
           __builtin_cpu_supports("avx512vl") != 0 && is_available(Isa::avx2);
#endif
  return isa == Isa::scalar;
}

Isa best_isa() { return *std::find_if(sets.rbegin(), sets.rend(), is_available); }

std::optional<Isa> isa_named(std::string_view name) {
  if (name == "auto") return best_isa();
  const auto found = std::ranges::find(sets, name, [](Isa isa) { return to_string(isa); });
  return found == sets.end() ? std::nullopt : std::optional(*found);
}

}  // namespace limcycle
