#include "limcycle/tests/analysis/lanes/pack_functions.hpp"

limcycle::test::PackFunctions limcycle::test::avx512_pack_functions() { return pack_functions<Pack<8, Isa::avx512>>(); }
