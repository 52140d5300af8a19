// Laws that own_law() rejects: tools/package checks with each -D that the compiler gives the reason in words.
#include "limcycle/models/friction/own_law.hpp"

struct Law {
  double output(const limcycle::Input<double>& in, limcycle::Mode, std::span<const double>) const { return in.v; }
#ifndef NO_SCALES
  limcycle::Scales scales() const { return {}; }
#endif
#ifdef HOLDS
  static constexpr auto holds = limcycle::Held::rate;
  limcycle::Held held(limcycle::Mode) const { return limcycle::Held::rate; }
#endif
#ifdef STATES_ALONE
  int states() const { return 1; }
#endif
#ifdef HALF_OF_THE_MODES
  int guards(limcycle::Mode) const { return 1; }
#endif
};

limcycle::Element law() { return limcycle::own_law(Law{}); }
