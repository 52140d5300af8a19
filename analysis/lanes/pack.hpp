#pragma once
#include <cstdint>

#include "limcycle/analysis/lanes/isa.hpp"

namespace limcycle {

/// N doubles, and as many whole numbers, that the compiler keeps in a register.
template <int N>
struct Registers;
template <>
struct Registers<2> {
  using Values [[gnu::vector_size(16)]] = double;
  using Bits [[gnu::vector_size(16)]] = std::int64_t;
};
template <>
struct Registers<4> {
  using Values [[gnu::vector_size(32)]] = double;
  using Bits [[gnu::vector_size(32)]] = std::int64_t;
};
template <>
struct Registers<8> {
  using Values [[gnu::vector_size(64)]] = double;
  using Bits [[gnu::vector_size(64)]] = std::int64_t;
};

/// Rounding of a * b + c: once if the set has such an instruction (avx2, avx512) and otherwise twice, or always twice.
enum class Products { fused, rounded };

/// N doubles that are computed on together, a Scalar for laws: one instruction each where `set` has registers of that
/// width. `set` and `products` are part of the type so that no function of one source file compiled with them can be
/// mistaken for that of another: a source that uses Pack<N, set, products> is compiled with the options of both, and
/// holds no other inline code. Within one set every machine rounds alike.
template <int N, Isa set, Products products = Products::fused>
struct Pack {
  static constexpr int lanes = N;
  using Values = typename Registers<N>::Values;
  using Bits = typename Registers<N>::Bits;

  /// Result of a comparison of two packs, lane by lane.
  struct Mask {
    Bits bits;  ///< -1 where true, 0 where not

    bool all() const {
      std::int64_t both = -1;
      for (int i = 0; i < N; ++i) both &= bits[i];
      return both != 0;
    }
    bool any() const {
      std::int64_t either = 0;
      for (int i = 0; i < N; ++i) either |= bits[i];
      return either != 0;
    }
    /// For conditions on parameters, which are the same in all lanes.
    explicit operator bool() const { return all(); }
    friend Mask operator&(Mask a, Mask b) { return {a.bits & b.bits}; }
    friend Mask operator|(Mask a, Mask b) { return {a.bits | b.bits}; }
    friend Mask operator!(Mask a) { return {~a.bits}; }
  };

  Values v{};

  Pack() = default;
  Pack(double same) : v(same - Values{}) {}  // NOLINT(google-explicit-constructor): constants mix freely with packs
  explicit Pack(Values values) : v(values) {}

  static Pack load(const double* from) {
    Pack p;
    for (int i = 0; i < N; ++i) p.v[i] = from[i];
    return p;
  }
  void store(double* to) const {
    for (int i = 0; i < N; ++i) to[i] = v[i];
  }
  double operator[](int lane) const { return v[lane]; }

  Pack operator-() const { return Pack(-v); }
  Pack operator+() const { return *this; }
  Pack& operator+=(const Pack& b) { return *this = *this + b; }
  Pack& operator-=(const Pack& b) { return *this = *this - b; }
  Pack& operator*=(const Pack& b) { return *this = *this * b; }
  Pack& operator/=(const Pack& b) { return *this = *this / b; }
  friend Pack operator+(const Pack& a, const Pack& b) { return Pack(a.v + b.v); }
  friend Pack operator-(const Pack& a, const Pack& b) { return Pack(a.v - b.v); }
  friend Pack operator*(const Pack& a, const Pack& b) { return Pack(a.v * b.v); }
  friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.v / b.v); }

  friend Mask operator<(const Pack& a, const Pack& b) { return {a.v < b.v}; }
  friend Mask operator>(const Pack& a, const Pack& b) { return {a.v > b.v}; }
  friend Mask operator<=(const Pack& a, const Pack& b) { return {a.v <= b.v}; }
  friend Mask operator>=(const Pack& a, const Pack& b) { return {a.v >= b.v}; }
  friend Mask operator==(const Pack& a, const Pack& b) { return {a.v == b.v}; }
  friend Mask operator!=(const Pack& a, const Pack& b) { return {a.v != b.v}; }

  friend Pack select(const Mask& condition, const Pack& yes, const Pack& no) {
    return Pack(condition.bits ? yes.v : no.v);
  }
  /// The smaller of a and b; b if one of them is NaN. `max` likewise.
  friend Pack min(const Pack& a, const Pack& b) { return Pack(a.v < b.v ? a.v : b.v); }
  friend Pack max(const Pack& a, const Pack& b) { return Pack(a.v > b.v ? a.v : b.v); }
  friend Pack abs(const Pack& a) { return from_bits(to_bits(a) & INT64_MAX); }
  friend Pack sqrt(const Pack& a) {
    Pack root;
    for (int i = 0; i < N; ++i) root.v[i] = __builtin_sqrt(a.v[i]);
    return root;
  }

  /// e^a within 2 units of the last place, gradual underflow included. exp(-inf) = 0, exp(inf) = inf, exp(NaN) = NaN.
  /// e^r on |r| <= ln(2)/2 by a Chebyshev interpolant of (e^r - 1 - r)/r^2 (own coefficients, relative error 2e-17).
  friend Pack exp(const Pack& a) {
    const Pack x = min(Pack(710.0), max(Pack(-746.0), a));  // NaN stays
    const Pack n = (x * 0x1.71547652b82fep+0 + magic) - magic;
    const Pack r = (x - n * 0x1.62e42fee00000p-1) - n * 1.9082149292705877e-10;
    const Pack q = ((((((((Pack(2.510038549551032e-08) * r + 2.7620088445409746e-07) * r + 2.7557268459997064e-06) * r +
                         2.4801521295954376e-05) *
                            r +
                        1.9841269863053618e-04) *
                           r +
                       1.3888888917213717e-03) *
                          r +
                      8.333333333330062e-03) *
                         r +
                     4.166666666662413e-02) *
                        r +
                    0x1.5555555555556p-3) *
                       r +
                   0.5;
    const Pack whole = (r * r * q + r) + 1.0;
    return scaled(whole, n);
  }

  /// Natural logarithm within 2 units of the last place; -inf at 0, NaN below.
  friend Pack log(const Pack& a) {
    const auto tiny = a < 0x1p-1000;
    const Pack x = select(tiny, a * 0x1p200, a);
    // x = m 2^e with m in [sqrt(1/2), sqrt(2)).
    const Bits shifted = to_bits(x) - 0x3fe6a09e667f3bcd;
    const Bits e = shifted >> 52;
    const Pack m = from_bits((shifted & 0x000fffffffffffff) + 0x3fe6a09e667f3bcd);
    const Pack exponent = from_integer(e) - select(tiny, Pack(200.0), Pack(0.0));
    const Pack f = m - 1.0, s = f / (2.0 + f), w = s * s;
    const Pack series =
        w * (((((((((Pack(2.0 / 21.0) * w + 2.0 / 19.0) * w + 2.0 / 17.0) * w + 2.0 / 15.0) * w + 2.0 / 13.0) * w +
                 2.0 / 11.0) *
                    w +
                2.0 / 9.0) *
                   w +
               2.0 / 7.0) *
                  w +
              0.4) *
                 w +
             2.0 / 3.0);
    // ln m = f - (f^2/2 - s (f^2/2 + series)): the large part is exact.
    const Pack half = 0.5 * f * f;
    const Pack value =
        exponent * 0x1.62e42fee00000p-1 + (f - (half - (s * (half + series) + exponent * 1.9082149292705877e-10)));
    const Pack special = select(a == 0.0, Pack(-__builtin_inf()), Pack(__builtin_nan("")));
    return select((a > 0.0) & (a < __builtin_inf()), value, select(a > 0.0, a, special));
  }

  /// a^p for a >= 0 and an exponent that is the same in all lanes: exact products for 1 and 2, else exp(p ln a), whose
  /// relative error is |p ln a| roundings.
  friend Pack power(const Pack& a, const Pack& p) {
    if (p.v[0] == 2.0) return a * a;
    if (p.v[0] == 1.0) return a;
    return exp(p * log(a));
  }

 private:
  static constexpr double magic = 0x1.8p52;  ///< adding it rounds to a whole number, whose bits come last

  static Bits to_bits(const Pack& a) { return (Bits)a.v; }
  static Pack from_bits(Bits bits) { return Pack((Values)bits); }
  /// a 2^n for whole n in -1100..1100, with gradual underflow.
  static Pack scaled(const Pack& a, const Pack& n) {
#if defined(__AVX512F__) && defined(__GNUC__) && !defined(__clang__)
    if constexpr (N == 8) return Pack(__builtin_ia32_scalefpd512_mask(a.v, n.v, a.v, -1, 4));
#endif
    // In two factors: the result may be finite although 2^n is not.
    const Pack first = max(Pack(-1000.0), min(Pack(1000.0), n));
    return a * two_to(first) * two_to(n - first);
  }
  /// 2^n for whole n in -1022..1023.
  static Pack two_to(const Pack& n) { return from_bits((to_bits(n + (magic + 1023.0)) << 52)); }
  /// Whole numbers below 2^51 in size.
  static Pack from_integer(Bits n) { return from_bits(n + to_bits(Pack(magic))) - magic; }
};

}  // namespace limcycle
