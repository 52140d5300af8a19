#pragma once
#include <optional>
#include <span>
#include <string_view>

namespace limcycle {

/// Instruction set that a kernel computes with. Results are the same on every machine that has it; those of different
/// sets differ by roundings.
enum class Isa {
  scalar,  ///< baseline of every machine that runs this program
  avx2,    ///< x86-64-v3: AVX2 and FMA, 4 lanes of double
  avx512,  ///< x86-64-v4: AVX-512 F, DQ and VL, 8 lanes
};

/// Doubles in one register of that set.
constexpr int lanes_of(Isa isa) { return isa == Isa::avx512 ? 8 : isa == Isa::avx2 ? 4 : 2; }

/// Name as results and command lines spell it: "x86-64-v3", "x86-64-v4"; "x86-64" for the portable one, "portable"
/// where the program was not built for x86-64.
std::string_view to_string(Isa isa);

/// True if this program was built with that set and this machine has it.
bool is_available(Isa isa);

/// The widest set that is available. Cost: two look-ups.
Isa best_isa();

/// All sets, narrowest first.
std::span<const Isa> all_isas();

/// The set of that name, "auto" for the best one. Empty for an unknown name.
std::optional<Isa> isa_named(std::string_view name);

}  // namespace limcycle
