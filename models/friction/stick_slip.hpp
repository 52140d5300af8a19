#pragma once
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// Common part of set-valued friction laws: at v = 0 the body sticks as long as the drive (the force that would hold
/// it) is within the break-away level, and F equals the drive. `Base` provides the levels.
/// Modes: 0 stuck, +1 and -1 sliding forwards and backwards.
template <class S, class Base>
struct StickSlip : Base, Memoryless<S> {
  static constexpr Mode stuck{0}, forward{1}, backward{-1};
  static constexpr bool output_needs_rate = true;
  static constexpr Held holds = Held::rate;

  Held held(Mode mode) const { return mode == stuck ? Held::rate : Held::nothing; }
  int guards(Mode mode) const { return mode == stuck ? 2 : 1; }

  /// Element of Sgn(v) that an output stands for: the sign of v while sliding, F/Fs at rest.
  S selection(Mode mode, const S& output) const {
    if (mode != stuck) return S(static_cast<double>(mode.value));
    return output / select(output < 0.0, this->Fs_minus, this->Fs);
  }

  /// Sliding: v in the direction of sliding. Stuck: distance of the drive from break-away, forwards and backwards.
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    if (mode == stuck) {
      g[0] = this->Fs - in.drive;
      g[1] = in.drive + this->Fs_minus;
    } else {
      g[0] = mode == forward ? in.v : -in.v;
    }
  }

  /// A stuck body breaks away in the direction of the guard that fired; a sliding one that has come to v = 0 sticks
  /// unless the drive exceeds the break-away level.
  Mode next(const Input<S>& in, Mode mode, std::span<S>, int fired) const {
    if (mode == stuck) return fired == 0 ? forward : backward;
    return at_rest(in.drive);
  }

  Mode start(const Input<double>& in, std::span<double>) const {
    return in.v > 0.0 ? forward : in.v < 0.0 ? backward : at_rest(S(in.drive));
  }

 private:
  Mode at_rest(const S& drive) const { return drive > this->Fs ? forward : drive < -this->Fs_minus ? backward : stuck; }
};

}  // namespace limcycle
