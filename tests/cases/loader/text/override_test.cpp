#include <catch2/catch.hpp>

#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/tests/cases/message.hpp"

using namespace limcycle;
using limcycle::test::message;
using limcycle::test::servo;

TEST_CASE("override --set replaces and creates, the last one wins") {
  const Case from = read_case(servo, "a.toml",
                              {"loop.controller.kd=2", "loop.controller.kd = 7.5", "loop.friction.delta=1.5",
                               "predict.starts=9", "title=\"new\""});
  CHECK(std::get<Pid>(from.loop->controller).kd == 7.5);
  CHECK(law_of<LuGre<double>>(*from.loop->friction).delta == 1.5);
  CHECK(from.predict.starts == 9);
  CHECK(from.title == "new");
  CHECK(from.overrides.size() == 5);
  CHECK(from.overrides[1] == "loop.controller.kd = 7.5");
}

TEST_CASE("override --set replaces a whole table or a list") {
  const Case from = read_case(servo, "a.toml", {"loop.friction={kind=\"coulomb\", Fc=2}", "search.amplitude=[1,2]"});
  CHECK(law_of<Coulomb<double>>(*from.loop->friction).Fc == 2.0);
  CHECK(from.predict.search->amplitude_max == 2.0);
}

TEST_CASE("mistakes in --set name it instead of file and line") {
  const auto said = [](const std::string& override) { return message(servo, {override}); };
  CHECK(said("loop.controller.kd") == "--set loop.controller.kd: must be PATH=VALUE, such as loop.controller.kd=6.0");
  CHECK(said("") == "--set '': must be PATH=VALUE, such as loop.controller.kd=6.0");
  CHECK(said("=1") == "--set =1: PATH must be names joined by dots, such as loop.controller.kd");
  CHECK(said("loop..kd=1") == "--set loop..kd=1: PATH must be names joined by dots, such as loop.controller.kd");
  CHECK(said("loop.plant.mass=").starts_with("--set loop.plant.mass=: not a TOML value ("));
  CHECK(said("loop.controller.kind=pid").starts_with("--set loop.controller.kind=pid: not a TOML value ("));
  CHECK(said("loop.controller.kind=pid").ends_with("a string needs quotes: 'loop.controller.kind=\"pid\"'"));
  CHECK(said("loop.plant.mass=1 2").starts_with("--set loop.plant.mass=1 2: not a TOML value ("));
  CHECK(said("loop.plant.mass=1\nx=2") == "--set loop.plant.mass=1\\x0Ax=2: must be one TOML value");
  CHECK(said("loop.plant.mass.x=1") == "--set loop.plant.mass.x=1: 'mass' is a number, not a table");
  CHECK(said("loop.plant.mass=-1") == "--set loop.plant.mass=-1: must be > 0 kg");
  CHECK(said("loop.plant.mass=nan") == "--set loop.plant.mass=nan: must be a finite number");
  CHECK(said("loop.plant.mass=\"abc\"") == "--set loop.plant.mass=\"abc\": must be a number, found a string");
  CHECK(said("loop.friction.Fs=0.5") == "--set loop.friction.Fs=0.5: must be at least Fc = 1 N");
  CHECK(said("loop.plant.maas=1") == "--set loop.plant.maas=1: unknown key; did you mean mass?");
  CHECK(said("loop.plnt.mass=1") == "--set loop.plnt.mass=1: loop.plnt: unknown key; did you mean plant?");
  CHECK(said("loop.plant={kind=\"mass\"}") ==
        "--set loop.plant={kind=\"mass\"}: loop.plant.mass: is required: mass, kg");
  CHECK(said("df.amplitude=[1]") ==
        "--set df.amplitude=[1]: df.frequency: is required: list or {from, to, points, spacing}, rad/s");
}

TEST_CASE("an override can break a rule of a value in the file, which is then blamed with both values") {
  CHECK(message(servo, {"loop.friction.Fc=2"}) == "a.toml:11: loop.friction.Fs = 1.5: must be at least Fc = 2 N");
}

TEST_CASE("an override can mend a mistake in the file") {
  CHECK(message(test::with(servo, "mass = 1.0", "mass = -1.0"), {"loop.plant.mass=1"}).empty());
}
