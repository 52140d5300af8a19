#include "limcycle/analysis/study/remedy/cause.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "limcycle/analysis/study/remedy/without.hpp"
#include "limcycle/models/element/of_controllers/clamped_pi.hpp"
#include "limcycle/models/friction/dry/stribeck_table.hpp"
#include "limcycle/tests/analysis/study/remedy/over_compensated.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using limcycle::test::coulomb;
using limcycle::test::lugre;
using limcycle::test::relay;
using limcycle::test::saturation;
using limcycle::test::servo_parts;

namespace {

LoopParts through(Element element, std::vector<double> numerator, std::vector<double> denominator, double delay) {
  LoopParts parts;
  parts.plant = TransferFunction{std::move(numerator), std::move(denominator), delay};
  parts.element = std::move(element);
  return parts;
}

Cause cause_in(const LoopParts& parts) {
  const PredictReport found = hunts(build_loop(parts), {}).found;
  return cause_of(parts, judging_of_variants({}, found), found.cycles);
}
CauseKind kind_of_cause(const LoopParts& parts) { return cause_in(parts).kind; }

}  // namespace

TEST_CASE("cause: integral action against stiction, for two laws and in other units") {
  CHECK(kind_of_cause(servo_parts(lugre())) == CauseKind::integral_action_and_stiction);
  LoopParts small = servo_parts(coulomb(1.5e-3, 1e-3));  // kg, N and N/m a thousandth: the same motion
  small.plant = Mass{1e-3, 0.0, 0.0};
  small.controller = test::pid(3e-3, 4e-3, 6e-3);
  const Cause cause = cause_in(small);
  CHECK(cause.kind == CauseKind::integral_action_and_stiction);
  REQUIRE(cause.tests.size() == 2);
  CHECK(cause.tests[0].hunts == Hunts::no);
  CHECK(cause.tests[1].hunts == Hunts::no);
}

TEST_CASE("cause: a measured curve that falls, with other points in each direction") {
  StribeckTable<double> law;
  law.velocities = {0.0005, 0.0015, 0.003};
  law.forces = {1.39, 1.05, 1.0};
  law.velocities_minus = {0.0005, 0.005};
  law.forces_minus = {1.3, 0.9};
  law.Fs = law.Fs_minus = 1.5;
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.friction = law;
  const Cause cause = cause_in(parts);
  CHECK(cause.kind == CauseKind::integral_action_and_stiction);
  CHECK_THAT(cause.why, Catch::Matchers::Contains("level at its least force"));
  const auto level = without_falling_friction(parts);
  REQUIRE(level);
  CHECK(level->friction->number("Fs") == 1.0);
  CHECK(level->friction->number("Fs_minus") == 0.9);
  CHECK_FALSE(without_falling_friction(*level));
}

TEST_CASE("cause: the falling friction curve on a belt, with the speed up to which it falls") {
  LoopParts parts;
  parts.plant = Belt{1.0, 2.0, 0.0, 0.1};
  parts.friction = lugre();
  const Cause cause = cause_in(parts);
  CHECK(cause.kind == CauseKind::negative_slope);
  // F = 1 + exp(-(v/vs)^2)/2 + 0.4 v is least where exp(-x^2) x = 0.4 vs, x = v/vs = 2.986.
  CHECK_THAT(cause.why, Catch::Matchers::Contains("up to 0.00299 m/s"));
}

TEST_CASE("cause: what is left of a belt without damping when friction no longer falls is a centre") {
  LoopParts parts;
  parts.plant = Belt{1.0, 2.0, 0.0, 0.1};
  parts.friction = coulomb(1.5, 1.0);
  const Cause cause = cause_in(parts);
  CHECK(cause.kind == CauseKind::negative_slope);
  CHECK(cause.tests.back().hunts == Hunts::neutral);
  CHECK_THAT(cause.why, Catch::Matchers::Contains("no limit cycle, though its swings go on for ever"));
}

TEST_CASE("cause: the relay, the dead time and too strong a compensation") {
  CHECK(kind_of_cause(through(relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0}, 0.0)) == CauseKind::relay);
  CHECK(kind_of_cause(through(saturation(1.0), {5.0}, {1.0, 1.0}, 1.0)) == CauseKind::delay);
  CHECK(kind_of_cause(test::over_compensated()) == CauseKind::over_compensation);
}

TEST_CASE("cause: a limit of the command, through which a loop that is only stable at high gain falls") {
  // K (s + 1)^3/(10 s + 1)^4 is unstable for K from 5.85 to 7,600: the limit lowers the gain of a large swing into it.
  for (const double limit : {1.0, 1e-3}) {
    const auto at = [&](double K) {
      return through(saturation(limit), {K, 3.0 * K, 3.0 * K, K}, {1e4, 4e3, 600.0, 40.0, 1.0}, 0.0);
    };
    const Cause cause = cause_in(at(2e4));
    CHECK(cause.kind == CauseKind::saturation);
    REQUIRE(cause.tests.size() == 1);
    CHECK(cause.tests[0].without == "without limits of the command");
    CHECK(cause.tests[0].hunts == Hunts::no);
    CHECK(kind_of_cause(at(100.0)) == CauseKind::undecided);  // unstable without the limit too
  }
}

TEST_CASE("cause: an unstable linear part is no single feature's fault") {
  // 8/(s + 1)^3 is at the border of stability; at 10 a saturation makes a limit cycle of it.
  for (const double gain : {10.0, 8.01}) {
    const Cause cause = cause_in(through(saturation(1.0), {gain}, {1.0, 3.0, 3.0, 1.0}, 0.0));
    CHECK(cause.kind == CauseKind::undecided);
    CHECK_FALSE(cause.why.empty());
  }
}

TEST_CASE("cause: taking a feature away changes nothing else, and says where there is none") {
  const LoopParts servo = servo_parts(lugre());
  CHECK_FALSE(without_delay(servo));
  CHECK_FALSE(without_limits(servo));
  CHECK_FALSE(without_compensation(servo));
  CHECK_FALSE(without_relay(servo, 1.0));
  const auto pd = without_integral_action(servo);
  REQUIRE(pd);
  CHECK(std::get<Pid>(pd->controller).ki == 0.0);
  CHECK(std::get<Pid>(pd->controller).kd == 6.0);
  CHECK_FALSE(without_integral_action(*pd));
  const auto level = without_falling_friction(servo);
  REQUIRE(level);
  CHECK(level->friction->number("Fs") == level->friction->number("Fc"));
  CHECK(level->friction->number("sigma0") == servo.friction->number("sigma0"));
  CHECK_FALSE(without_falling_friction(*level));
}

TEST_CASE("cause: a PI that holds its integral back, a block of a diagram, has integral action and a limit") {
  ClampedPi<double> pi;
  pi.kp = 3.0;
  pi.ki = 4.0;
  pi.limit = 5.0;
  LoopParts parts;
  Diagram& diagram = parts.diagram.emplace();
  diagram.output = {1.0, "axis", "y"};
  diagram.blocks = {{"axis", "diagram.axis", Plant(Mass{1.0, 6.0, 0.0}), {{{1.0, "pi", ""}}}},
                    {"pi", "diagram.pi", Element(pi), {{{1.0, "r", ""}, {-1.0, "axis", "y"}}}},
                    {"friction", "diagram.friction", coulomb(1.5, 1.0), {}, Contact::opposes, "axis"}};
  const auto own = [](const std::optional<LoopParts>& of) {
    return *std::get<Element>(of->diagram->blocks[1].what).as<ClampedPi<double>>();
  };
  const auto proportional = without_integral_action(parts), free = without_limits(parts);
  REQUIRE(proportional);
  REQUIRE(free);
  CHECK(own(proportional).ki == 0.0);
  CHECK(own(proportional).kp == 3.0);
  CHECK(own(free).limit > 1e8);
  CHECK(own(free).ki == 4.0);
  CHECK(kind_of_cause(parts) == CauseKind::integral_action_and_stiction);
}

TEST_CASE("cause: integral action is seen in a controller however it is written") {
  LoopParts servo = servo_parts(coulomb(1.5, 1.0));
  TransferFunctionController polynomials;  // the PID with a derivative filter of 0.01 s
  polynomials.numerator = {6.03, 3.04, 4.0};
  polynomials.denominator = {0.01, 1.0, 0.0};
  servo.controller = polynomials;
  CHECK(kind_of_cause(servo) == CauseKind::integral_action_and_stiction);
  StateSpaceController matrices;
  const StateSpace own = polynomials.model().ss;
  Eigen::MatrixXd T(2, 2);
  T << 2.0, 1.0, -0.5, 3.0;
  matrices.A = T * own.A * T.inverse();
  matrices.B = T * own.B;
  matrices.C = own.C * T.inverse();
  matrices.D = own.D;
  servo.controller = matrices;
  const Cause cause = cause_in(servo);
  CHECK(cause.kind == CauseKind::integral_action_and_stiction);
  CHECK(cause.tests[0].without == "without integral action");
}
