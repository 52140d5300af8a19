#include <catch2/catch.hpp>

#include "limcycle/cases/loader/sections/parameters.hpp"
#include "limcycle/models/catalogue.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using limcycle::test::message;
using limcycle::test::servo;
using limcycle::test::with;

TEST_CASE("a loop is read with all its parts") {
  const Case from = read_case("title = \"T\"\n[loop]\nreference = 2\nload = -1.5\n" + std::string(servo), "dir/a.toml");
  CHECK(from.title == "T");
  CHECK(from.file == "dir/a.toml");
  REQUIRE(from.loop);
  CHECK(from.loop->reference == 2.0);
  CHECK(from.loop->load == -1.5);
  CHECK(kind_of(from.loop->plant) == "mass");
  CHECK(std::get<Pid>(from.loop->controller).kd == 6.0);
  REQUIRE(from.loop->friction);
  const auto& lugre = law_of<LuGre<double>>(*from.loop->friction);
  CHECK(lugre.Fs == 1.5);
  CHECK(lugre.sigma0 == 1e5);
  CHECK_FALSE(from.loop->element);
  REQUIRE(from.predict.search);
  CHECK(from.predict.search->amplitude_min == 1e-6);
  CHECK(from.predict.search->frequency_max == 1000.0);
  CHECK(&df_element(from) == &*from.loop->friction);
}

TEST_CASE("title is the name of the file unless given, controller is none, set-point and load are 0") {
  const Case from =
      read_case("[loop.plant]\nkind = \"mass\"\nmass = 2\n[loop.friction]\nkind = \"coulomb\"\nFc = 1\n", "x/y.toml");
  CHECK(from.title == "y");
  CHECK(kind_of(from.loop->controller) == "none");
  CHECK(from.loop->reference == 0.0);
  CHECK(from.loop->load == 0.0);
  CHECK_FALSE(from.predict.search);
}

TEST_CASE("a cascade: what holds its integral back needs a limit and an integral") {
  const auto cascade = [](const std::string& more) {
    return message(
        "[loop.plant]\nkind = \"mass\"\nmass = 1.0\n[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n"
        "[loop.controller]\nkind = \"cascade\"\nposition_kp = 2.0\nvelocity_kp = 5.0\n" +
        more);
  };
  CHECK(cascade("").empty());
  CHECK(cascade("velocity_ki = 4.0\nlimit = 3.0\nanti_windup = \"back-calculation\"\n").empty());
  CHECK_THAT(cascade("velocity_ki = 4.0\nanti_windup = \"back-calculation\"\n"),
             StartsWith("a.toml:12: loop.controller.anti_windup") && Contains("needs a limit"));
  CHECK_THAT(cascade("limit = 3.0\nanti_windup = \"back-calculation\"\n"), Contains("needs velocity_ki"));
  CHECK(cascade("velocity_ki = 4.0\nlimit = 3.0\nanti_windup = \"clamp\"\n").empty());
  CHECK_THAT(cascade("limit = 3.0\nanti_windup = \"clamp\"\n"), Contains("needs velocity_ki"));
  CHECK_THAT(cascade("acceleration_feedforward = 1.0\n[simulate]\nduration = 1.0\n"
                     "reference = {kind = \"sine\", amplitude = 1.0, frequency = 1.0}\n"),
             Contains("simulate.reference") && Contains("acceleration_feedforward is not simulated"));
}

TEST_CASE("a PID: one way to hold its integral back at a time, and in a diagram blocks of their own") {
  const auto pid = [](const std::string& more) {
    return message(
        "[loop.plant]\nkind = \"mass\"\nmass = 1.0\n[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n"
        "[loop.controller]\nkind = \"pid\"\nkp = 2.0\n" +
        more);
  };
  CHECK(pid("ki = 1.0\nintegral_limit = 2.0\n").empty());
  CHECK(pid("ki = 1.0\nleak = 0.1\nintegral_band = 2.0\n").empty());
  CHECK_THAT(pid("integral_limit = 2.0\n"),
             StartsWith("a.toml:10: loop.controller.integral_limit") && Contains("needs ki"));
  CHECK_THAT(pid("ki = 1.0\nintegral_limit = 0.0\n"), Contains("must be > 0"));
  CHECK_THAT(pid("ki = 1.0\nintegral_band = 2.0\nintegral_limit = 2.0\n"), Contains("cannot stand beside"));
  CHECK_THAT(pid("ki = 1.0\nleak = 0.1\nintegral_limit = 2.0\n"), Contains("cannot stand beside leak"));
  CHECK(pid("ki = 1.0\nintegral_reset = 2.0\nreset_interval = 0.1\n").empty());
  CHECK_THAT(pid("ki = 1.0\nintegral_reset = 2.1\n"), StartsWith("a.toml:11: loop.controller.integral_reset"));
  CHECK_THAT(pid("integral_reset = 1.0\n"), Contains("needs ki"));
  CHECK_THAT(pid("ki = 1.0\nreset_interval = 0.1\n"),
             StartsWith("a.toml:11: loop.controller.reset_interval") && Contains("needs integral_reset"));
  CHECK_THAT(pid("ki = 1.0\nleak = 0.1\nintegral_reset = 1.0\n"), Contains("cannot stand beside leak"));
  CHECK_THAT(pid("ki = 1.0\nintegral_limit = 2.0\nintegral_reset = 1.0\n"),
             StartsWith("a.toml:12: loop.controller.integral_reset") && Contains("cannot stand beside integral_limit"));
  CHECK_THAT(pid("ki = 1.0\nsample_time = 0.01\nintegral_reset = 1.0\n"), Contains("not for a sampled controller"));
  CHECK_THAT(pid("ki = 1.0\nsample_time = 0.01\nintegral_band = 2.0\n"), Contains("not for a sampled controller"));
  CHECK(pid("ki = 1.0\nintegral_reset = 2.0\nreset_speed = 0.1\n").empty());
  CHECK(pid("ki = 1.0\nleak = 0.1\nintegral_dead_zone = 0.1\n").empty());
  CHECK(pid("ki = 1.0\nintegral_dead_zone = 0.1\nintegral_hysteresis = 0.1\n").empty());
  CHECK_THAT(pid("ki = 1.0\nintegral_hysteresis = 0.1\n"),
             StartsWith("a.toml:11: loop.controller.integral_hysteresis") && Contains("needs integral_dead_zone"));
  CHECK_THAT(pid("integral_dead_zone = 0.1\n"), Contains("needs ki"));
  CHECK_THAT(
      pid("ki = 1.0\nintegral_dead_zone = 0.1\nintegral_reset = 1.0\n"),
      StartsWith("a.toml:12: loop.controller.integral_reset") && Contains("cannot stand beside integral_dead_zone"));
  CHECK_THAT(pid("ki = 1.0\nreset_speed = 0.1\n"),
             StartsWith("a.toml:11: loop.controller.reset_speed") && Contains("needs integral_reset"));
  CHECK_THAT(pid("ki = 1.0\nintegral_reset = 1.0\nreset_speed = 0.1\nreset_interval = 1.0\n"),
             StartsWith("a.toml:13: loop.controller.reset_interval") && Contains("not beside reset_speed"));
  CHECK_THAT(pid("ki = 1.0\nintegral_reset = 1.0\nreset_speed = 0.1\n[loop.error]\nkind = \"dead-zone\"\nhalf_width = "
                 "0.1\n"),
             Contains("loop.controller.reset_speed") && Contains("cannot stand beside [loop.error]"));
  CHECK_THAT(
      message("[diagram]\noutput = \"axis.y\"\n[[diagram.block]]\nname = \"axis\"\nkind = \"mass\"\nmass = 1.0\n"
              "input = \"c\"\n[[diagram.block]]\nname = \"c\"\nkind = \"pid\"\nkp = 1.0\nki = 1.0\n"
              "integral_limit = 2.0\ninput = \"r - axis.y\"\n[[diagram.block]]\nname = \"f\"\nkind = \"coulomb\"\n"
              "Fc = 1.0\non = \"axis\"\n"),
      Contains("clamped-pi"));
}

TEST_CASE("impulses of a PID: all their numbers or none, and none of a sampled controller") {
  const auto pid = [](const std::string& more) {
    return message(
        "[loop.plant]\nkind = \"mass\"\nmass = 1.0\n[loop.friction]\nkind = \"coulomb\"\nFc = 1.0\n"
        "[loop.controller]\nkind = \"pid\"\nkp = 2.0\n" +
        more);
  };
  const std::string all =
      "impulse = 2.0\nimpulse_width = 0.1\nimpulse_pause = 0.5\nimpulse_band = 0.01\nimpulse_speed = 0.001\n";
  CHECK(pid(all).empty());
  CHECK(pid(all + "[loop.error]\nkind = \"dead-zone\"\nhalf_width = 0.1\n").empty());  // by the error before it
  CHECK_THAT(pid("impulse_band = 0.1\n"),
             StartsWith("a.toml:10: loop.controller.impulse_band") && Contains("needs impulse"));
  CHECK_THAT(pid("impulse = 2.0\nimpulse_width = 0.1\nimpulse_pause = 0.5\nimpulse_speed = 0.001\n"),
             StartsWith("a.toml:10: loop.controller.impulse") && Contains("needs impulse_band"));
  CHECK_THAT(pid(all + "sample_time = 0.01\n"), Contains("not for a sampled controller"));
  CHECK_THAT(message("[diagram]\noutput = \"axis.y\"\n[[diagram.block]]\nname = \"axis\"\nkind = \"mass\"\nmass = 1.0\n"
                     "input = \"c\"\n[[diagram.block]]\nname = \"c\"\nkind = \"pid\"\nkp = 1.0\n" +
                     all +
                     "input = \"r - axis.y\"\n[[diagram.block]]\nname = \"f\"\nkind = \"coulomb\"\nFc = 1.0\non = "
                     "\"axis\"\n"),
             Contains("let the impulses be a block of their own"));
}

TEST_CASE("a ramp as reference") {
  const Case from = read_case("[loop]\nreference = {kind = \"ramp\", rate = 0.25}\n" + std::string(servo), "a.toml");
  CHECK(from.loop->reference == 0.0);
  CHECK(from.loop->reference_rate == 0.25);
  CHECK(message("[loop]\nreference = {kind = \"ramp\"}\n" + std::string(servo)) ==
        "a.toml:2: loop.reference.rate: is required: slope of the ramp, 1/s");
  CHECK(message("[loop]\nreference = \"ramp\"\n" + std::string(servo)) ==
        "a.toml:2: loop.reference = \"ramp\": must be a number or {kind = \"ramp\", rate = ...}, found a string");
}

TEST_CASE("a lone law or element needs no plant") {
  const Case law = read_case("[loop.friction]\nkind = \"coulomb\"\nFc = 2\n", "a.toml");
  CHECK_FALSE(law.loop);
  REQUIRE(law.element);
  CHECK(law.element_path == "loop.friction");
  CHECK(law_of<Coulomb<double>>(df_element(law)).Fs == 2.0);
  const Case relay = read_case("[loop.element]\nkind = \"relay\"\nlevel = 3\n", "a.toml");
  CHECK(relay.element_path == "loop.element");
  CHECK(df_element(relay).kind() == "relay");
  CHECK_THROWS_WITH(need_loop(relay), "a.toml: loop.plant: is required by this command: the case holds a lone element");
  CHECK_THROWS_WITH(need_df(relay), "a.toml: df: is required by this command: add [df] with amplitude and frequency");
  CHECK_THROWS_WITH(need_simulate(relay),
                    "a.toml: simulate: is required by this command: add [simulate] with duration");
}

TEST_CASE("a friction law may stand in series, and beside friction") {
  const Case from =
      read_case(with(servo, "[loop.friction]", "[loop.element]\nkind = \"dahl\"\nFc = 1\nsigma0 = 10\n[loop.friction]"),
                "a.toml", {"loop.controller.tf=0.01"});
  REQUIRE(from.loop->element);
  CHECK(from.loop->element->kind() == "dahl");
  CHECK(df_element(from).kind() == "lugre");
}

TEST_CASE("what is missing from a loop") {
  CHECK(message("title = \"x\"\n") == "a.toml:1: loop: is required: a case needs [loop] or [diagram]");
  CHECK(message("[search]\namplitude=[1,2]\nfrequency=[1,2]\n") ==
        "a.toml:1: loop: is required: a case needs [loop] or [diagram]");
  CHECK(message("[loop.controller]\nkind = \"pid\"\nkp = 1\n[loop.friction]\nkind = \"coulomb\"\nFc = 1\n") ==
        "a.toml:1: loop.plant: is required: a loop needs [loop.plant]");
  CHECK(message("\n[loop.plant]\nkind = \"mass\"\nmass = 1\n") ==
        "a.toml:2: loop: needs a nonlinear element: add [loop.friction], [loop.element] or [loop.error]");
  CHECK(message("[loop.plant]\nmass = 1\n").starts_with("a.toml:1: loop.plant.kind: is required: which plant (mass, "));
  CHECK(message("loop = 3\n") == "a.toml:1: loop = 3: must be a table, found a number");
  CHECK(message("[loop]\nplant = \"mass\"\n") == "a.toml:2: loop.plant = \"mass\": must be a table, found a string");
}

TEST_CASE("a kind that is misspelt is answered with the nearest name, one that is not there with all") {
  CHECK(message(with(servo, "\"lugre\"", "\"hysteresis\"")) ==
        "a.toml:10: loop.friction.kind = \"hysteresis\": unknown friction law; known: " +
            case_file::joined(kinds_of(catalogue_of_elements().friction_laws)));
  CHECK(message(with(servo, "\"lugre\"", "\"lugr\"")) ==
        "a.toml:10: loop.friction.kind = \"lugr\": unknown friction law; did you mean \"lugre\"?");
  CHECK(message(with(servo, "\"lugre\"", "\"max-well-slip\"")) ==
        "a.toml:10: loop.friction.kind = \"max-well-slip\": unknown friction law; did you mean \"maxwell-slip\"?");
  CHECK(message(with(servo, "\"lugre\"", "\"relay\"")) ==
        "a.toml:10: loop.friction.kind = \"relay\": is an element in series: it belongs in [loop.element]");
  CHECK(message(with(servo, "\"lugre\"", "3")) ==
        "a.toml:10: loop.friction.kind = 3: must be a string, found a number");
  CHECK(message(with(servo, "\"pid\"", "\"fuzzy\"")) ==
        "a.toml:5: loop.controller.kind = \"fuzzy\": unknown controller; known: none, pid, transfer-function, "
        "state-space, cascade");
}

TEST_CASE("a Froude pendulum with clearance is no loop") {
  const std::string text =
      "[loop.plant]\nkind = \"froude-pendulum\"\nmass = 5\narm = 0.2\ninertia = 0.25\nshaft_radius = 0.02\n"
      "shaft_speed = 4\nclearance = 0\n[loop.friction]\nkind = \"coulomb\"\nFc = 7\n";
  const Case from = read_case(text, "a.toml");
  CHECK(std::get<FroudePendulum>(from.loop->plant).gravity == 9.81);
  CHECK(message(with(text, "clearance = 0", "clearance = 1e-4")) ==
        "a.toml:8: loop.plant.clearance = 0.0001: must be 0 in a loop: clearance needs `limcycle experiment "
        "froude-pendulum`");
}

TEST_CASE("friction compensation is a key of every controller") {
  const Case from = read_case(with(servo, "kd = 6.0", "kd = 6.0\nfriction_compensation = 1"), "a.toml");
  CHECK(std::get<Pid>(from.loop->controller).friction_compensation == 1.0);
  CHECK(build_loop(*from.loop).elements.size() == 2);
  const Case none = read_case(with(servo, "kind = \"pid\"\nkp = 3.0\nki = 4.0\nkd = 6.0", "kind = \"none\""), "a.toml",
                              {"loop.controller.friction_compensation=0.5", "loop.controller.lag=0.1"});
  CHECK(std::get<NoController>(none.loop->controller).friction_compensation == 0.5);
  CHECK(message(servo, {"loop.controller.friction_compensation=-1"}) ==
        "--set loop.controller.friction_compensation=-1: must be >= 0 N");
  CHECK(message(with(servo, "kd = 6.0", "kd = 6.0\nfriction_compensatoin = 1.0")) ==
        "a.toml:9: loop.controller.friction_compensatoin: unknown key; did you mean friction_compensation?");
  CHECK(message("[loop.plant]\nkind = \"mass\"\nmass = 1\n[loop.controller]\nkind = \"pid\"\nkp = 1\n"
                "friction_compensation = 2\n[loop.element]\nkind = \"relay\"\nlevel = 1\n") ==
        "a.toml:7: loop.controller.friction_compensation = 2: has nothing to compensate: add [loop.friction]");
}

TEST_CASE("an element on the error, alone and beside the others") {
  const std::string error = "[loop.error]\nkind = \"dead-zone\"\nhalf_width = 0.01\n";
  const Case from = read_case(std::string(servo) + error, "a.toml");
  REQUIRE(from.loop->error);
  CHECK(law_of<DeadZone<double>>(*from.loop->error).half_width == 0.01);
  CHECK(df_element(from).kind() == "lugre");
  CHECK(from.element_path == "loop.friction");
  const Case all =
      read_case(std::string(servo) + error + "[loop.element]\nkind = \"saturation\"\nlimit = 3\n", "a.toml");
  CHECK(build_loop(*all.loop).elements.size() == 4);
  const Case alone = read_case(
      "[loop.plant]\nkind = \"mass\"\nmass = 1\n[loop.controller]\nkind = \"pid\"\nkp = 1\nkd = 1\ntf = 0.1\n"
      "[loop.error]\nkind = \"quantizer\"\nstep = 0.5\n",
      "a.toml");
  CHECK(law_of<Quantizer<double>>(df_element(alone)).step == 0.5);
  CHECK(alone.element_path == "loop.error");
}

TEST_CASE("mistakes in the element on the error") {
  const auto error = [](const std::string& body) {
    return message(std::string(servo) + "[loop.error]\n" + body + "\n");
  };
  CHECK(error("kind = \"dead-zone\"\nhalf_width = 0.01").empty());
  CHECK(error("kind = \"quantizer\"\nstep = 0.01") ==
        "a.toml:4: loop.controller.tf: must be > 0: kd differentiates the output of the quantizer, which jumps");
  CHECK(error("kind = \"quantizer\"").starts_with("a.toml:20: loop.error.step: is required: "));
  CHECK(error("kind = \"quantizer\"\nstep = 0") == "a.toml:22: loop.error.step = 0: must be > 0");
  CHECK(error("kind = \"quantizer\"\nstpe = 1") == "a.toml:22: loop.error.stpe: unknown key; did you mean step?");
  CHECK(error("kind = \"quantiser\"\nstep = 1") ==
        "a.toml:21: loop.error.kind = \"quantiser\": unknown element on the error; did you mean \"quantizer\"?");
  CHECK(error("kind = \"relay\"\nlevel = 1") ==
        "a.toml:21: loop.error.kind = \"relay\": does not act on the error (dead-zone, quantizer, saturation may)");
  CHECK(error("step = 1") ==
        "a.toml:20: loop.error.kind: is required: which element on the error (dead-zone, quantizer, saturation)");
  CHECK(message("[loop.error]\nkind = \"quantizer\"\nstep = 1\n") ==
        "a.toml:1: loop.plant: is required: a loop needs [loop.plant]");
  CHECK(message(with(servo, "[loop.friction]", "[loop.element]\nkind = \"quantizer\"\nstep = 1\n[loop.friction]")) ==
        "a.toml:10: loop.element.kind = \"quantizer\": acts on the error: it belongs in [loop.error]");
  CHECK(message("[loop.plant]\nkind = \"mass\"\nmass = 1\n[loop.friction]\nkind = \"coulomb\"\nFc = 1\n"
                "[loop.error]\nkind = \"quantizer\"\nstep = 1\n") ==
        "a.toml:7: loop.error: needs a controller: with friction alone the error is not used");
}

TEST_CASE("what a loop makes itself is no kind that a case may name") {
  for (const auto* kind : {"friction-compensation", "output-rate", "delayed-relay"}) {
    const std::string written = "kind = \"" + std::string(kind) + "\"\n";
    for (const auto* section : {"element", "friction", "error"}) {
      const std::string said = message("[loop.plant]\nkind = \"mass\"\nmass = 1\n[loop." + std::string(section) +
                                       "]\n" + written + "level = 1\n");
      CHECK(said.find(": unknown ") != std::string::npos);
      CHECK(said.find(kind) != std::string::npos);
    }
  }
}

TEST_CASE("the first mistake in the file is the one reported") {
  const std::string text = with(with(servo, "sigma0", "sigm0"), "sigma2", "zeta");
  CHECK(message(text) == "a.toml:14: loop.friction.sigm0: unknown key; did you mean sigma0?");
}

TEST_CASE("rules between parameters show the values that break them") {
  CHECK(message(with(servo, "Fs = 1.5", "Fs = 0.5")) == "a.toml:11: loop.friction.Fs = 0.5: must be at least Fc = 1 N");
  CHECK(message(with(servo, "Fs = 1.5", "Fs = 1.5\nFc_minus = 2.0")) ==
        "a.toml:9: loop.friction.Fs_minus = 1.5 (by default): must be at least Fc_minus = 2 N");
}

TEST_CASE("rules of the loop name the part to blame") {
  CHECK(message(with(servo, "kind = \"mass\"\nmass = 1.0",
                     "kind = \"transfer-function\"\nnumerator = [1.0]\ndenominator = [1.0, 2.0]")) ==
        "a.toml:1: loop.plant: needs relative degree 2 or more from force to position when there is friction");
  const std::string relay =
      "[loop.plant]\nkind = \"transfer-function\"\nnumerator = [1]\ndenominator = [1, 1]\n"
      "[loop.controller]\nkind = \"pid\"\nkp = 1\nkd = 1\n[loop.element]\nkind = \"relay\"\nlevel = 1\n";
  CHECK(message(relay) ==
        "a.toml:5: loop.controller.tf: must be > 0: the plant has relative degree 1 and kd differentiates its output");
  CHECK(message(with(servo, "mass = 1.0", "mass = 1e-320")) ==
        "a.toml:1: loop.plant: overflows: its parameters differ too much in size");
}

TEST_CASE("improper and non-causal plants") {
  const auto plant = [](const std::string& body) {
    return message("[loop.plant]\n" + body + "\n[loop.element]\nkind = \"relay\"\nlevel = 1\n");
  };
  CHECK(plant("kind = \"transfer-function\"\nnumerator = [1, 2, 3]\ndenominator = [1, 2]") ==
        "a.toml:3: loop.plant.numerator = [1, 2, 3]: the numerator has a higher degree than the denominator");
  CHECK(plant("kind = \"transfer-function\"\nnumerator = [1, 2]\ndenominator = [1, 2]") ==
        "a.toml:3: loop.plant.numerator = [1, 2]: must have a lower degree than the denominator: the plant must be "
        "strictly proper");
  CHECK(plant("kind = \"transfer-function\"\nnumerator = [1]\ndenominator = [1, 2]\ndelay = -0.1") ==
        "a.toml:5: loop.plant.delay = -0.1: must be >= 0 s");
  CHECK(plant("kind = \"transfer-function\"\nnumerator = [1]\ndenominator = []") ==
        "a.toml:4: loop.plant.denominator = []: must not be empty or zero");
  CHECK(plant("kind = \"first-order\"\ngain = 0\ntime_constant = 2") ==
        "a.toml:3: loop.plant.gain = 0: must not be zero");
  CHECK(plant("kind = \"second-order\"\ngain = 1\ntime_constant = 0\ndamping_ratio = 1") ==
        "a.toml:4: loop.plant.time_constant = 0: must be > 0 s");
  CHECK(plant("kind = \"zpk\"\nzeros = [1, 2]\npoles = [-1]\ngain = 1")
            .starts_with("a.toml:3: loop.plant.zeros = [1, 2]: "));
  CHECK_THAT(plant("kind = \"zpk\"\nzeros = []\npoles = [[-1, 2], -3]\ngain = 1"),
             StartsWith("a.toml:4: loop.plant.poles = [[-1, 2], -3]: ") && Contains("conjugate"));
  CHECK_THAT(plant("kind = \"zpk\"\nzeros = [[-1, 2]]\npoles = [-1, -2, -3]\ngain = 1"),
             StartsWith("a.toml:3: loop.plant.zeros = [[-1, 2]]: ") && Contains("conjugate"));
  CHECK(plant("kind = \"state-space\"\nA = [[0, 1], [0, 0]]\nB = [[0], [1]]\nC = [[1, 0]]\nD = [[1]]") ==
        "a.toml:6: loop.plant.D = [[1]]: must be zero: the plant must be strictly proper");
  CHECK(plant("kind = \"state-space\"\nA = [[0, 1], [0]]\nB = [[0], [1]]\nC = [[1, 0]]") ==
        "a.toml:3: loop.plant.A[1] = [0]: must have 2 entries like the first row, found 1");
  CHECK(plant("kind = \"state-space\"\nA = [1, 2]\nB = [[0], [1]]\nC = [[1, 0]]") ==
        "a.toml:3: loop.plant.A[0] = 1: must be a list of numbers, found a number");
  CHECK(plant("kind = \"zpk\"\nzeros = []\npoles = [[1, 2, 3]]\ngain = 1") ==
        "a.toml:4: loop.plant.poles[0] = [1, 2, 3]: must be a number or a pair [re, im]");
  CHECK(plant("kind = \"transfer-function\"\nnumerator = [1, \"two\"]\ndenominator = [1, 2, 3]") ==
        "a.toml:3: loop.plant.numerator[1] = \"two\": must be a number, found a string");
}

TEST_CASE("pairs and numbers make a list of poles, rows make a matrix") {
  const Case zpk = read_case(
      "[loop.plant]\nkind = \"zpk\"\nzeros = []\npoles = [[-1, 2], [-1, -2.0], -3]\ngain = 4\n"
      "[loop.element]\nkind = \"relay\"\nlevel = 1\n",
      "a.toml");
  const auto& plant = std::get<ZeroPoleGain>(zpk.loop->plant);
  CHECK(plant.poles == std::vector<std::complex<double>>{{-1, 2}, {-1, -2}, {-3, 0}});
  const Case ss = read_case(
      "[loop.plant]\nkind = \"state-space\"\nA = [[0, 1], [2, 3]]\nB = [[0], [1]]\nC = [[1, 0]]\n"
      "[loop.element]\nkind = \"relay\"\nlevel = 1\n",
      "a.toml");
  const auto& A = std::get<StateSpacePlant>(ss.loop->plant).A;
  CHECK(A == (Eigen::Matrix2d() << 0, 1, 2, 3).finished());
}

TEST_CASE("a list of a plant has a limit") {
  std::string many = "1";
  for (int i = 0; i < 300; ++i) many += ", 1";
  const std::string said = message("[loop.plant]\nkind = \"transfer-function\"\nnumerator = [1]\ndenominator = [" +
                                   many + "]\n[loop.element]\nkind = \"relay\"\nlevel = 1\n");
  CHECK(said == "a.toml:4: loop.plant.denominator: must have at most 201 entries, found 301");
}
