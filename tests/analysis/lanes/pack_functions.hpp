#pragma once
#include "limcycle/analysis/lanes/pack.hpp"

/// Functions of packs over raw arrays, one source for each instruction set: see pack_functions_scalar.cpp.
namespace limcycle::test {

struct PackFunctions {
  void (*exp)(const double* from, double* to, int count);
  void (*log)(const double* from, double* to, int count);
  void (*sqrt)(const double* from, double* to, int count);
  /// a^p with one p for all.
  void (*power)(const double* from, double exponent, double* to, int count);
  /// |a|, the smaller and the larger of a and b, and a where a < b, else -b.
  void (*choose)(const double* a, const double* b, double* abs, double* min, double* max, double* select, int count);
};

PackFunctions scalar_pack_functions();
PackFunctions avx2_pack_functions();
PackFunctions avx512_pack_functions();

/// `count` must be a multiple of P::lanes.
template <class P>
PackFunctions pack_functions() {
  return {
      [](const double* from, double* to, int count) {
        for (int i = 0; i < count; i += P::lanes) exp(P::load(from + i)).store(to + i);
      },
      [](const double* from, double* to, int count) {
        for (int i = 0; i < count; i += P::lanes) log(P::load(from + i)).store(to + i);
      },
      [](const double* from, double* to, int count) {
        for (int i = 0; i < count; i += P::lanes) sqrt(P::load(from + i)).store(to + i);
      },
      [](const double* from, double exponent, double* to, int count) {
        for (int i = 0; i < count; i += P::lanes) power(P::load(from + i), P(exponent)).store(to + i);
      },
      [](const double* a, const double* b, double* absolute, double* least, double* most, double* chosen, int count) {
        for (int i = 0; i < count; i += P::lanes) {
          const P p = P::load(a + i), q = P::load(b + i);
          abs(p).store(absolute + i);
          min(p, q).store(least + i);
          max(p, q).store(most + i);
          select(p < q, p, -q).store(chosen + i);
        }
      }};
}

}  // namespace limcycle::test
