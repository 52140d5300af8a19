#include "limcycle/tests/analysis/lanes/pack_functions.hpp"

limcycle::test::PackFunctions limcycle::test::scalar_pack_functions() { return pack_functions<Pack<2, Isa::scalar>>(); }
