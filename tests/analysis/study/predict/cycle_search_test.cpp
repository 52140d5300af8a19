#include "limcycle/analysis/study/predict/cycle_search.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/analysis/study/map/ensemble_outcomes.hpp"
#include "limcycle/analysis/study/predict/cycle_hunt.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Bristles so stiff that the usual tolerance breaks stiction early.
LuGre<double> stiff() {
  auto law = lugre();
  law.sigma0 = 1e9;
  law.sigma1 = 2.0 * std::sqrt(1e9);
  return law;
}

}  // namespace

TEST_CASE("cycle search: floor, ceiling and accuracy follow from the box and from what is asked") {
  const Loop loop = servo(coulomb(1.5, 1.0));
  const SearchBox box{1e-5, 2.0, 0.01, 100.0};
  const double unit = output_per_input(loop);
  const SettleOptions settings = cycle_search(loop, box, 1e-6);
  CHECK(settings.amplitude_floor == Approx(1e-5 * unit));
  CHECK(settings.amplitude_ceiling == Approx(2e4 * unit));
  CHECK(settings.rtol == SettleOptions{}.rtol);
  CHECK(settings.shooting.accuracy == 1e-6);
  CHECK(settings.shooting.tolerance == Approx(0.1 * settings.shooting.rtol));
}

TEST_CASE("cycle search: stiff bristles are simulated as accurately by every command") {
  const Loop loop = servo(stiff());
  const SearchBox box = default_search_box(loop);
  const double rtol = cycle_search(loop, box, 1e-8).rtol;
  CHECK(rtol < SettleOptions{}.rtol);
  CHECK(CycleHunt(loop, {}, box).rtol() == rtol);
  CHECK(ensemble_question(loop).rtol <= rtol);
}
