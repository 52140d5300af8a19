#include "limcycle/tests/analysis/lanes/pack_functions.hpp"

limcycle::test::PackFunctions limcycle::test::avx2_pack_functions() { return pack_functions<Pack<4, Isa::avx2>>(); }
