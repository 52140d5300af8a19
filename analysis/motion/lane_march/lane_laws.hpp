#pragma once
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

/// LuGre in units of vs. `usual`: symmetric, exp(-(v/vs)^2), constant damping, as compile-time constants.
template <class P, bool usual>
struct LaneLuGre {
  template <class S>
  [[gnu::always_inline]] static LuGre<S> law(const P* numbers, int curve) {
    LuGre<S> law;
    law.Fs = S(numbers[0]);
    law.Fc = S(numbers[1]);
    law.Fs_minus = usual ? law.Fs : S(numbers[2]);
    law.Fc_minus = usual ? law.Fc : S(numbers[3]);
    law.sigma0 = S(numbers[4]);
    law.sigma1 = S(numbers[5]);
    law.sigma2 = S(numbers[6]);
    law.vd = usual ? S(0.0) : S(numbers[7]);
    law.delta = usual ? S(2.0) : S(numbers[8]);
    law.vs = S(1.0);
    law.curve.index = usual ? 0 : curve;
    return law;
  }
};

template <class P>
struct LaneDahl {
  template <class S>
  [[gnu::always_inline]] static Dahl<S> law(const P* numbers, int) {
    Dahl<S> law;
    law.Fc = S(numbers[0]);
    law.sigma0 = S(numbers[1]);
    return law;
  }
};

}  // namespace limcycle
